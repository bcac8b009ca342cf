"""Writes the texts of the standard ROS 2 messages that jamgrip uses, or checks them.

    standard_messages.py FOLDER            writes FOLDER/<package>/msg/<Type>.msg
    standard_messages.py FOLDER --check    exits with 1 and names the files that differ

The texts come from the type store of the PyPI package `rosbags`.
"""

import pathlib
import sys

from rosbags.typesys import Stores, get_typestore

# What the topics carry; the types they contain are found from here.
ROOTS = [
    "diagnostic_msgs/msg/DiagnosticArray",
    "geometry_msgs/msg/Accel",
    "geometry_msgs/msg/PoseStamped",
    "geometry_msgs/msg/TwistStamped",
    "geometry_msgs/msg/WrenchStamped",
    "rosgraph_msgs/msg/Clock",
    "sensor_msgs/msg/FluidPressure",
    "sensor_msgs/msg/JointState",
    "sensor_msgs/msg/PointCloud2",
    "shape_msgs/msg/Mesh",
    "std_msgs/msg/Bool",
    "std_msgs/msg/Float64",
    "tf2_msgs/msg/TFMessage",
    "visualization_msgs/msg/MarkerArray",
]

SEPARATOR = "=" * 80 + "\n"


def texts():
    """Path of each message file, below the folder, and its text."""
    store = get_typestore(Stores.ROS2_JAZZY)
    found = {}
    for root in ROOTS:
        own, *parts = store.generate_msgdef(root, ros_version=2)[0].split(SEPARATOR)
        package, _, name = root.split("/")
        found[f"{package}/msg/{name}.msg"] = own
        for part in parts:
            head, text = part.split("\n", 1)
            package, name = head.removeprefix("MSG: ").split("/")
            found[f"{package}/msg/{name}.msg"] = text
    return {path: text.strip() + "\n" for path, text in found.items()}


def main():
    folder = pathlib.Path(sys.argv[1])
    if "--check" in sys.argv:
        on_disk = {
            str(path.relative_to(folder)): path.read_text() for path in folder.glob("*/msg/*.msg")
        }
        expected = texts()
        differing = sorted(
            path
            for path in on_disk.keys() | expected.keys()
            if on_disk.get(path) != expected.get(path)
        )
        if differing:
            sys.exit("differ from the type store of rosbags: " + ", ".join(differing))
        return
    for path, text in texts().items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)


if __name__ == "__main__":
    main()
