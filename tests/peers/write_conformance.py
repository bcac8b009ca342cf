"""Writes the public conformance data set of MCAP, byte for byte, into a folder: a file for each of six
inputs and each combination of features that makes sense for it.

    write_conformance.py FOLDER

The files themselves are kept with the format's source (github.com/foxglove/mcap, tests/conformance/data) and are
in no package. They are small and regular, so they are generated here from the description of the format, and
compared with published SHA-256 sums. Prints the number of files and of sums.
"""

import hashlib
import itertools
import pathlib
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
ATTACHMENT, ATTACHMENT_INDEX, STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END = range(9, 16)
FEATURES = ("ch", "mx", "st", "rsh", "rch", "ax", "mdx", "chx", "sum", "pad")
PADDING = b"\x01\xff\xff"

SCHEMA_1 = (SCHEMA, 1, "Example", "c", b"\4\5\6")
CHANNEL_1 = (CHANNEL, 1, 1, "example", "a", {"foo": "bar"})
INPUTS = {
    "NoData": [],
    "OneSchemalessMessage": [(CHANNEL, 1, 0, "example", "text", {}), (MESSAGE, 1, 10, 2, 1)],
    "OneMessage": [SCHEMA_1, CHANNEL_1, (MESSAGE, 1, 10, 2, 1)],
    "OneAttachment": [(ATTACHMENT, 2, 1, "myFile", "application/octet-stream", b"\1\2\3")],
    "OneMetadata": [(METADATA, "myMetadata", {"foo": "bar"})],
    "TenMessages": [SCHEMA_1, CHANNEL_1]
    + [(MESSAGE, 1, i, t, t) for i, t in enumerate((0, 2, 1, 3, 3, 5, 4, 7, 8, 9))],
}
# Published sums of these files, from Git LFS pointers.
SUMS = {
    "NoData-st-sum": "78aed9973f50c4ebc30a8eab27453f6e42b2984c4f402d57e002dafdf217b744",
    "OneMetadata-mdx-st-sum": "6d7681e1536e3c61a0d9755b1b10b9a7ad4c2042855a839ce96c8c024bc64316",
    "OneSchemalessMessage-ch-chx-mx-rch-st-sum": "e9b4aa6f672b611783230a6d642e50dcdf8620ee938226f8e86ca9f22ec64848",
    "TenMessages-ch-chx-mx-rch-rsh-st-sum": "813c4eb55e1195e5af9482f60d9b214cd083a8805720ec1663812637d716e4d5",
    "TenMessages-ch-chx-mx-pad-rch-rsh-st-sum": "54f3c5a0ca350cd4cf6326992926f491178a46aa694686e3781aa19c4255fc88",
    "TenMessages-ch-mx-rch": "5a738f776cf6f27f4956d777a6c5e2374650c0d861bd0a2b20c5e15c2152ef7c",
    "TenMessages-pad-rch-rsh-st-sum": "a586164671262b2b56b13ff15b5f340257c4c3d343e58b05f79b507de206833d",
}
# Published checksums of both sections of this file, from the description of its records.
CHECKSUMS = {"OneAttachment-ax-pad-st-sum": (1702036232, 2541810275)}


def text(it):
    return struct.pack("<I", len(it.encode())) + it.encode()


def table(entries):
    body = b"".join(entries)
    return struct.pack("<I", len(body)) + body


def pairs(it):
    return table(text(key) + text(value) for key, value in it.items())


def record(opcode, body, pad=b""):
    return struct.pack("<BQ", opcode, len(body) + len(pad)) + body + pad


def body_of(kind, *fields):
    """The body of a record of an input."""
    if kind == SCHEMA:
        number, name, encoding, data = fields
        return struct.pack("<H", number) + text(name) + text(encoding) + struct.pack("<I", len(data)) + data
    if kind == CHANNEL:
        number, schema, topic, encoding, metadata = fields
        return struct.pack("<HH", number, schema) + text(topic) + text(encoding) + pairs(metadata)
    if kind == MESSAGE:
        return struct.pack("<HIQQ", *fields) + b"\1\2\3"
    if kind == METADATA:
        name, metadata = fields
        return text(name) + pairs(metadata)
    log, create, name, media, data = fields
    body = struct.pack("<QQ", log, create) + text(name) + text(media) + struct.pack("<Q", len(data)) + data
    return body + struct.pack("<I", zlib.crc32(body))


def whole(records, on):
    pad = PADDING if "pad" in on else b""
    out = bytearray(MAGIC + record(HEADER, text("") + text(""), pad))
    chunk, messages, indexes = b"", [], {CHUNK_INDEX: b"", ATTACHMENT_INDEX: b"", METADATA_INDEX: b""}
    for kind, *fields in records:
        # Records in chunks are not padded, nor are messages, because their data extend to the end.
        if kind == MESSAGE:
            messages.append((fields[2], len(chunk)))
        if "ch" in on and kind in (SCHEMA, CHANNEL, MESSAGE):
            chunk += record(kind, body_of(kind, *fields))
            continue
        begin = len(out)
        out += record(kind, body_of(kind, *fields), b"" if kind == MESSAGE else pad)
        length = len(out) - begin
        if kind == ATTACHMENT and "ax" in on:
            log, create, name, media, data = fields
            body = struct.pack("<QQQQQ", begin, length, log, create, len(data)) + text(name) + text(media)
            indexes[ATTACHMENT_INDEX] += record(ATTACHMENT_INDEX, body, pad)
        if kind == METADATA and "mdx" in on:
            body = struct.pack("<QQ", begin, length) + text(fields[0])
            indexes[METADATA_INDEX] += record(METADATA_INDEX, body, pad)
    times = [time for time, _ in messages] or [0]
    if "ch" in on:
        begin = len(out)
        head = struct.pack("<QQQI", min(times), max(times), len(chunk), zlib.crc32(chunk)) + text("")
        out += record(CHUNK, head + struct.pack("<Q", len(chunk)) + chunk)
        chunk_end = len(out)
        if "mx" in on:
            entries = table(struct.pack("<QQ", *it) for it in messages)
            out += record(MESSAGE_INDEX, struct.pack("<H", 1) + entries, pad)
        if "chx" in on:
            offsets = table([struct.pack("<HQ", 1, chunk_end)] if "mx" in on else [])
            body = struct.pack("<QQQQ", min(times), max(times), begin, chunk_end - begin) + offsets
            body += struct.pack("<Q", len(out) - chunk_end) + text("") + struct.pack("<QQ", len(chunk), len(chunk))
            indexes[CHUNK_INDEX] += record(CHUNK_INDEX, body, pad)
    out += record(DATA_END, struct.pack("<I", zlib.crc32(out)), pad)
    return finish(out, records, on, pad, times, indexes)


def finish(out, records, on, pad, times, indexes):
    """Adds the summary section and the footer."""
    counts = {kind: sum(it[0] == kind for it in records) for kind in (MESSAGE, SCHEMA, CHANNEL, ATTACHMENT, METADATA)}
    start, groups = len(out), []

    def group(opcode, content):
        nonlocal out
        if content:
            groups.append(struct.pack("<BQQ", opcode, len(out), len(content)))
            out += content

    for kind, feature in ((SCHEMA, "rsh"), (CHANNEL, "rch")):
        repeated = [record(kind, body_of(*it), pad) for it in records if it[0] == kind and feature in on]
        group(kind, b"".join(repeated))
    if "st" in on:
        body = struct.pack("<QHIIII", *counts.values(), int("ch" in on)) + struct.pack("<QQ", min(times), max(times))
        body += table([struct.pack("<HQ", 1, counts[MESSAGE])] if counts[MESSAGE] else [])
        group(STATISTICS, record(STATISTICS, body, pad))
    for opcode in (METADATA_INDEX, ATTACHMENT_INDEX, CHUNK_INDEX):
        group(opcode, indexes[opcode])
    summary = start if groups else 0
    offsets = len(out) if "sum" in on else 0
    if "sum" in on:
        out += b"".join(record(SUMMARY_OFFSET, it, pad) for it in groups)
    footer = struct.pack("<BQQQ", FOOTER, 20, summary, offsets)
    return bytes(out) + footer + struct.pack("<I", zlib.crc32(bytes(out[start:]) + footer)) + MAGIC


def makes_sense(records, on):
    kinds = {it[0] for it in records}
    needs = {"ax": ATTACHMENT, "mdx": METADATA, "rsh": SCHEMA, "rch": CHANNEL, "ch": CHANNEL}
    return (
        all(kind in kinds for feature, kind in needs.items() if feature in on)
        and ("ch" in on or not on & {"chx", "mx"})
        and ("sum" not in on or on & {"chx", "rsh", "rch", "mdx", "ax", "st"})
    )


def main(folder):
    known = 0
    names = []
    for base, records in INPUTS.items():
        for chosen in itertools.product((False, True), repeat=len(FEATURES)):
            on = {feature for feature, is_on in zip(FEATURES, chosen) if is_on}
            if not makes_sense(records, on):
                continue
            name = "-".join([base, *sorted(on)])
            content = whole(records, on)
            if name in SUMS:
                assert hashlib.sha256(content).hexdigest() == SUMS[name], (name, len(content))
                known += 1
            for checksum in CHECKSUMS.get(name, ()):
                assert struct.pack("<I", checksum) in content, name
            (pathlib.Path(folder) / f"{name}.mcap").write_bytes(content)
            names.append(name)
    assert known == len(SUMS)
    print(len(names), known)


main(sys.argv[1])
