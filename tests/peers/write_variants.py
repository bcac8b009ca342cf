"""Writes the same five messages, an attachment and a metadata record with every combination of the
features that the `mcap` package's writer has, each into a file of its own.

    write_variants.py FOLDER

Prints the number of files. The name of a file lists its features.
"""

import itertools
import pathlib
import sys

from mcap.writer import CompressionType, IndexType, Writer

FLAGS = ("chunked", "indexed", "channels", "schemas", "statistics", "offsets", "crcs")


def write(path, compression, flags):
    on = dict(zip(FLAGS, flags))
    with path.open("wb") as stream:
        writer = Writer(
            stream,
            chunk_size=64,
            compression=compression,
            index_types=IndexType.ALL if on["indexed"] else IndexType.NONE,
            repeat_channels=on["channels"],
            repeat_schemas=on["schemas"],
            use_chunking=on["chunked"],
            use_statistics=on["statistics"],
            use_summary_offsets=on["offsets"],
            enable_crcs=on["crcs"],
            enable_data_crcs=on["crcs"],
        )
        writer.start(profile="", library="variants")
        schema = writer.register_schema(name="pkg/msg/T", encoding="ros2msg", data=b"uint8 x")
        channels = [
            writer.register_channel("/with", "cdr", schema, metadata={"key": "value"}),
            writer.register_channel("/without", "", 0),
        ]
        writer.add_metadata("notes", {"a": "b"})
        for i in range(5):
            writer.add_message(channels[i % 2], log_time=i, publish_time=10 + i, sequence=i, data=bytes([i] * 40))
        writer.add_attachment(create_time=1, log_time=2, name="file", media_type="text/plain", data=b"contents")
        writer.finish()


def main():
    folder = pathlib.Path(sys.argv[1])
    n_files = 0
    for compression in (CompressionType.NONE, CompressionType.LZ4, CompressionType.ZSTD):
        for flags in itertools.product((False, True), repeat=len(FLAGS)):
            names = [name for name, on in zip(FLAGS, flags) if on]
            write(folder / f"{compression.name}-{'-'.join(names)}.mcap", compression, flags)
            n_files += 1
    print(n_files)


if __name__ == "__main__":
    main()
