"""values.py NAME FOLDER: prints `sha256  NAME: kind` for each kind of file in FOLDER (mha, png, json, ...).

Only values are hashed. Prose, versions, dates, devices, paths and times may change and are left out."""
import hashlib
import json
import os
import re
import struct
import sys
import zlib

NOT_A_RESULT = re.compile(r".*_(ms|ns)$|frames_per_s$|stages$|device_bytes$|runs$|frontier$|advice$")
WORDS_OF_RESULTS = {"strategy", "precision", "part", "other", "dial", "repair"}


def json_values(value, key=""):
    """Numbers, booleans and null under their keys; of strings only those that stand for a decision."""
    if isinstance(value, dict):
        return {k: json_values(v, k) for k, v in value.items() if not NOT_A_RESULT.match(k)}
    if isinstance(value, list):
        return [json_values(v, key) for v in value]
    return value if not isinstance(value, str) or key in WORDS_OF_RESULTS else ""


def read_json(data):
    return json.dumps(json_values(json.loads(data)), sort_keys=True).encode()


def read_mha(data):
    """The header without comments and names, and the values."""
    header, values = data.split(b"ElementDataFile = LOCAL\n", 1)
    return b"\n".join(x for x in header.split(b"\n") if not re.match(b"Comment|ChannelNames", x)) + values


def read_png(data):
    """Pixels before compression, size, and the numbers of the range that is shown."""
    at, kept, pixels = 8, b"", b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IDAT":
            pixels += body
        elif kind != b"tEXt":
            kept += kind + body
        elif body.startswith(b"Range\0"):
            kept += b" ".join(re.findall(rb"[-+.\d]+(?:e[-+]?\d+)?", body))
        at += 12 + length
    return kept + zlib.decompress(pixels)


def read_tiff(data):
    """Of each page every tag but its places in the file, title and software; then its values."""
    assert data[:4] == b"II*\0"
    at, kept = struct.unpack("<I", data[4:8])[0], b""
    while at:
        count, tags = struct.unpack("<H", data[at : at + 2])[0], {}
        for i in range(count):
            tag, kind, n, place = struct.unpack("<HHII", data[at + 2 + 12 * i : at + 14 + 12 * i])
            size = n * {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 12: 8}[kind]
            start = place if size > 4 else at + 10 + 12 * i
            tags[tag] = (kind, n, data[start : start + size])
        strips = [struct.unpack("<%d%s" % (n, "HI"[kind - 3]), raw) for kind, n, raw in (tags[273], tags[279])]
        kept += repr([(tag, tags[tag]) for tag in sorted(tags) if tag not in (270, 273, 279, 305)]).encode()
        kept += b"".join(data[start : start + size] for start, size in zip(*strips))
        at = struct.unpack("<I", data[at + 2 + 12 * count : at + 6 + 12 * count])[0]
    return kept


def read_ply(data):
    header, values = data.split(b"end_header\n", 1)
    return b"\n".join(x for x in header.split(b"\n") if not x.startswith(b"comment")) + values


def read_csv(data):
    return data.split(b"\n", 1)[1]  # the first line names the columns


READERS = {"json": read_json, "mha": read_mha, "png": read_png, "tif": read_tiff, "ply": read_ply, "csv": read_csv}
name, folder = sys.argv[1:]
hashes = {}
for path, folders, files in os.walk(folder):
    folders.sort()
    for file in sorted(files):
        full = os.path.join(path, file)
        if os.path.getsize(full) == 0:
            continue  # nothing on standard output
        kind = file.rsplit(".", 1)[1]
        with open(full, "rb") as stream:
            data = stream.read()
        hashed = hashes.setdefault(kind, hashlib.sha256())
        # A scene that was written is a result as it stands.
        values = data if file == "thorax.json" else READERS[kind](data)
        hashed.update(("%s %d\n" % (os.path.relpath(full, folder), len(values))).encode() + values)
for kind, hashed in sorted(hashes.items()):
    print(hashed.hexdigest() + "  " + name + ": " + kind)
