"""Reads a rosbag2 folder with two independent libraries and prints its contents as JSON.

    read_bag.py FOLDER

Every message is decoded by `rosbags` (types from the recording alone, folder opened through its
metadata.yaml) and by `mcap` with `mcap-ros2-support`; both must find the same numbers of messages.
"""

import json
import math
import pathlib
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader


def plain(value):
    """A decoded message as something JSON can hold; long arrays shortened."""
    if hasattr(value, "__dataclass_fields__"):
        fields = value.__dataclass_fields__
        return {name: plain(getattr(value, name)) for name in fields if name != "__msgtype__"}
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value[:64]]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def with_rosbags(folder):
    """Topic: type, count, count in metadata.yaml, times, first message."""
    topics = {}
    with AnyReader([folder]) as reader:
        for connection in reader.connections:
            topics[connection.topic] = {
                "type": connection.msgtype,
                "hash": connection.digest,
                "listed": connection.msgcount,
                "count": 0,
                "first": None,
            }
        for connection, time_ns, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            topic = topics[connection.topic]
            topic["count"] += 1
            topic["last_ns"] = time_ns
            if topic["first"] is None:
                topic["first"] = plain(message)
                topic["first_ns"] = time_ns
        return {
            "topics": topics,
            "message_count": reader.message_count,
            "start_ns": reader.start_time,
            "end_ns": reader.end_time,
        }


def with_mcap(folder):
    """Counts by topic in all files, and the metadata of the last file."""
    counts, first_topics = {}, []
    last_ns = -1
    # By number: the tenth file comes after the ninth.
    files = sorted(folder.glob("*.mcap"), key=lambda file: (len(file.stem), file.stem))
    for file in files:
        with file.open("rb") as stream:
            reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
            of_file = []
            for _, channel, message, _ in reader.iter_decoded_messages(log_time_order=False):
                counts[channel.topic] = counts.get(channel.topic, 0) + 1
                assert message.log_time >= last_ns, "log times go backwards"
                last_ns = message.log_time
                of_file.append(channel.topic)
            first_topics.append(sorted(of_file[:3]))
            summary = reader.get_summary()
            header = reader.get_header()
            described = {
                "profile": header.profile,
                "library": header.library,
                "channels": len(summary.channels),
                "qos": {
                    channel.topic: channel.metadata["offered_qos_profiles"]
                    for channel in summary.channels.values()
                },
                "compressions": sorted({chunk.compression for chunk in summary.chunk_indexes}),
                "attachments": {
                    attachment.name: attachment.data.decode(errors="replace")
                    for attachment in reader.iter_attachments()
                },
                "metadata": {record.name: record.metadata for record in reader.iter_metadata()},
            }
    return {"counts": counts, "files": len(files), "first_topics": first_topics, **described}


def main():
    folder = pathlib.Path(sys.argv[1])
    by_rosbags, by_mcap = with_rosbags(folder), with_mcap(folder)
    for name, topic in by_rosbags["topics"].items():
        counts = (topic["listed"], topic["count"], by_mcap["counts"].get(name, 0))
        assert len(set(counts)) == 1, f"{name}: metadata.yaml, rosbags, mcap count {counts}"
    print(json.dumps({"rosbags": by_rosbags, "mcap": by_mcap}))


if __name__ == "__main__":
    main()
