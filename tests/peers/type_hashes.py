"""Compares type hashes, given as NAME=HASH, with those of `rosbags`: from its own type store if it
has the type, else computed from msgs/.

Prints the numbers of types compared with its own store and with msgs/.
"""

import pathlib
import sys

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

store = get_typestore(Stores.ROS2_JAZZY)
theirs = set(store.fielddefs)
own = {}
for file in [*pathlib.Path("msgs/msg").glob("*.msg"), *pathlib.Path("msgs").glob("*/*/msg/*.msg")]:
    package = "jamgrip_msgs" if file.parts[1] == "msg" else file.parts[2]
    name = f"{package}/msg/{file.stem}"
    if name not in theirs:
        own.update(get_types_from_msg(file.read_text(), name))
store.register(own)

given = dict(argument.split("=") for argument in sys.argv[1:])
assert given, "no hashes given"
differing = {
    name: (hash_, store.hash_rihs01(name))
    for name, hash_ in given.items()
    if hash_ != store.hash_rihs01(name)
}
if differing:
    sys.exit(f"type: (ours, that of rosbags): {differing}")
known = sum(name in theirs for name in given)
print(known, len(given) - known)
