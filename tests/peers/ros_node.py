"""A small ROS 2 node on an independent DDS implementation: topics by their ROS names and types."""

import os
import struct
import time

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

import ros_types as t

RELIABLE = Policy.Reliability.Reliable(duration(milliseconds=100))


class Node:
    """Subscriptions keep everything until it is taken; publishers are reliable with depth 1."""

    def __init__(self):
        self.participant = DomainParticipant(int(os.environ.get("ROS_DOMAIN_ID", "0")))

    def subscribe(self, name, kind, depth=10, latched=False):
        durability = Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile
        qos = Qos(RELIABLE, durability, Policy.History.KeepLast(depth))
        return DataReader(self.participant, Topic(self.participant, f"rt{name}", kind), qos=qos)

    def publish(self, name, kind):
        qos = Qos(RELIABLE, Policy.Durability.Volatile, Policy.History.KeepLast(1))
        return DataWriter(self.participant, Topic(self.participant, f"rt{name}", kind), qos=qos)

    def nodes(self, timeout_s=10.0):
        """Names, counts of readers and of writers of the nodes in `ros_discovery_info`."""
        qos = Qos(RELIABLE, Policy.Durability.TransientLocal, Policy.History.KeepLast(1))
        topic = Topic(self.participant, "ros_discovery_info", t.ParticipantEntitiesInfo)
        reader = DataReader(self.participant, topic, qos=qos)
        found = {}
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            for info in reader.take(N=100):
                for node in getattr(info, "node_entities_info_seq", []):
                    name = node.node_namespace.rstrip("/") + "/" + node.node_name
                    if not found:
                        # A node publishes its list again with every topic it opens.
                        deadline = time.monotonic() + 0.5
                    found[name] = (len(node.reader_gid_seq), len(node.writer_gid_seq))
            time.sleep(0.02)
        return found


def wait_for(condition, what, timeout_s=30.0):
    """Waits until `condition()` is true; fails with `what` otherwise."""
    deadline = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < deadline, f"waited {timeout_s} s for {what}"
        time.sleep(0.01)


def columns(cloud):
    """The named columns of a point cloud, as lists of numbers."""
    formats = {5: "i", 6: "I", 7: "f", 8: "d"}
    data = bytes(cloud.data)
    assert len(data) == cloud.row_step == cloud.point_step * cloud.width * cloud.height
    read = {}
    for it in cloud.fields:
        entry = struct.Struct("<" + formats[it.datatype])
        places = range(it.offset, len(data), cloud.point_step)
        read[it.name] = [entry.unpack_from(data, place)[0] for place in places]
    return read
