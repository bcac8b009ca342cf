"""Compares type hashes, given as NAME=HASH, with those that `rosbags` computes from msgs/."""

import pathlib
import sys

from rosbags.typesys import Stores, get_types_from_msg, get_typestore

store = get_typestore(Stores.ROS2_JAZZY)
own = {}
for file in pathlib.Path("msgs/msg").glob("*.msg"):
    own.update(get_types_from_msg(file.read_text(), f"jamgrip_msgs/msg/{file.stem}"))
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
