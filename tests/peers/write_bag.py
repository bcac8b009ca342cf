"""Writes a rosbag2 folder with `rosbags`, as other programs do.

    write_bag.py FOLDER

Numbers on /numbers every 10 ms from a time since the epoch on, and vacuum commands on the topic of
the gripper: -1000 Pa times the number of the command, every 50 ms.
"""

import pathlib
import sys

from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

START_NS = 1_700_000_000_000_000_000


def main():
    store = get_typestore(Stores.ROS2_JAZZY)
    float64 = store.types["std_msgs/msg/Float64"]
    folder = pathlib.Path(sys.argv[1])
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        numbers = writer.add_connection("/numbers", float64.__msgtype__, typestore=store)
        vacuum = writer.add_connection("/jamgrip/vacuum_cmd", float64.__msgtype__, typestore=store)
        for i in range(500):
            at_ns = START_NS + i * 10_000_000
            data = store.serialize_cdr(float64(data=float(i)), float64.__msgtype__)
            writer.write(numbers, at_ns, data)
            if i % 5 == 0:
                command = float64(data=-1000.0 * (i // 5))
                data = store.serialize_cdr(command, float64.__msgtype__)
                writer.write(vacuum, at_ns, data)


if __name__ == "__main__":
    main()
