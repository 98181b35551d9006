"""Damage that keeps a file's checksums and structure, so that it reaches the code behind them: sizes and types in
headers of PNG, HDR, EXR, PLY, glTF, GLB, JPEG, TIFF and VDB. Unlike damage to bytes it lands on a field each time."""
import json
import re
import struct
import zlib

import damage
import vdb_fields


def png(data, rng):
    """Another width, height, depth, colour or interlace, or damage to a chunk, with the right checksum."""
    chunks, at = [], 8
    while at + 8 <= len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        chunks.append([name, data[at + 8:at + 8 + size]])
        at += 12 + size
    chunk = chunks[0] if rng.random() < 0.6 else rng.choice(chunks)
    if chunk[0] == b"IHDR" and rng.random() < 0.9:
        fields = list(struct.unpack(">IIBBBBB", chunk[1]))
        which = rng.choice([0, 0, 1, 1, 2, 3, 4, 5, 6])
        fields[which] = rng.choice(damage.NUMBERS) & 0xffffffff if which < 2 else rng.choice([0, 1, 2, 3, 4, 6, 8, 16, 255])
        chunk[1] = struct.pack(">IIBBBBB", *fields)
    elif chunk[0] == b"IDAT" and rng.random() < 0.7:
        try:
            chunk[1] = zlib.compress(damage.bytes_of(zlib.decompress(chunk[1]), rng))
        except zlib.error:
            chunk[1] = damage.bytes_of(chunk[1], rng)
    else:
        chunk[1] = damage.bytes_of(chunk[1], rng)
    if rng.random() < 0.2:
        chunks.insert(rng.randrange(len(chunks) + 1), rng.choice(chunks))
    return data[:8] + b"".join(struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))
                               for name, body in chunks)


def hdr(data, rng):
    """Another size, or damage to the run lengths."""
    match = re.search(rb"-Y (\d+) \+X (\d+)\n", data)
    if not match:
        return damage.bytes_of(data, rng)
    if rng.random() < 0.3:
        return data[:match.end()] + damage.bytes_of(data[match.end():], rng)
    sizes = [match.group(1), match.group(2)]
    sizes[rng.randrange(2)] = b"%d" % rng.choice([0, 1, 7, 9, 32767, 32768, 65535, 65536, 2**31 - 1, 2**31, 2**63])
    head = rng.choice([b"-Y %s +X %s\n", b"-Y %s +X %s\n", b"+Y %s +X %s\n", b"+X %s -Y %s\n"]) % tuple(sizes)
    return data[:match.start()] + head + data[match.end():]


def exr_attributes(data):
    """(place of the value, its size, type, name) of each attribute of the first header, and the header's end."""
    found, at = [], 8
    while data[at]:
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        size = struct.unpack_from("<I", data, type_end + 1)[0]
        found.append((type_end + 5, size, data[name_end + 1:type_end], data[at:name_end]))
        at = type_end + 5 + size
    return found, at + 1


def exr(data, rng):
    """Another data window, compression, channel, tile or own attribute, or damage to chunks and their table."""
    attributes, end = exr_attributes(data)
    if rng.random() < 0.3:
        return data[:end] + damage.bytes_of(data[end:], rng)
    at, size, kind, name = rng.choice([a for a in attributes if a[1] > 0])
    if kind == b"box2i":
        window = list(struct.unpack_from("<4i", data, at))
        window[rng.randrange(4)] = rng.choice([0, -1, 8, 9, 4095, 65535, 2**30, 2**31 - 1, -2**31, -2**30])
        return damage.poke(data, at, struct.pack("<4i", *window))
    if kind in (b"compression", b"lineOrder", b"tiledesc") or size == 1:
        return damage.poke(data, at + rng.randrange(size), bytes([rng.choice([*range(12), 127, 128, 255])]))
    if kind == b"string" and rng.random() < 0.7:  # the length stays, or the file no longer holds together
        value = damage.text_of(data[at:at + size], rng)[:size]
        return damage.poke(data, at, value.ljust(size, b" "))
    if kind in (b"float", b"v2f", b"chromaticities", b"m44f", b"double"):
        return damage.poke(data, at + 4 * rng.randrange(max(1, size // 4)), struct.pack("<f", rng.choice(damage.FLOATS)))
    if kind == b"int":
        return damage.poke(data, at, struct.pack("<I", rng.choice(damage.NUMBERS) & 0xffffffff))
    return data[:at] + damage.bytes_of(data[at:at + size], rng)[:size].ljust(size, b"\0") + data[at + size:]


def ply(data, rng):
    """Another count, type or property; the body stays."""
    head, mark, body = data.partition(b"end_header\n")
    if rng.random() < 0.4:
        count = rng.choice([0, 1, 35, 37, 10**6, 2**31 - 1, 2**31, 2**32, 2**63, -1])
        return re.sub(rb"(element \w+) \d+", rb"\1 %d" % count, head, count=rng.randrange(1, 3)) + mark + body
    if rng.random() < 0.5:
        old, new = rng.sample([b"float", b"double", b"uchar", b"int", b"uint", b"short", b"list", b"char"], 2)
        return head.replace(old, new, rng.randrange(1, 4)) + mark + body
    return head + mark + damage.bytes_of(body, rng) if rng.random() < 0.5 else damage.text_of(head, rng) + mark + body


def change_json(node, rng):
    """Replaces one value of a tree, mostly a number or text by another."""
    places = []

    def walk(value):
        for key in list(value) if isinstance(value, dict) else range(len(value)):
            places.append((value, key))
            if isinstance(value[key], (dict, list)):
                walk(value[key])

    walk(node)
    value, key = rng.choice(places)
    numbers = [0, -1, 1, 2, 5, 5120, 5126, 65535, 65536, 2**31 - 1, 2**31, 2**32, 2**53, 2**63, 1e38, 1e308, -1e-320, 0.5]
    texts = ["", "VEC3", "SCALAR", "MAT4", "mesh.gltf", "../..", "/dev/zero", "data:,", "data:;base64,AAAA", "%00", "a" * 5000]
    kind = rng.randrange(8)
    if kind < 4:
        value[key] = rng.choice(numbers)
    elif kind == 4:
        value[key] = rng.choice(texts)
    elif kind == 5:
        value[key] = rng.choice([None, True, [], {}, [[]] * 50])
    elif kind == 6 and isinstance(value[key], list):
        value[key] = value[key] * rng.choice([0, 2, 1000])
    else:
        other, name = rng.choice(places)
        value[key] = json.loads(json.dumps(other[name]))


def gltf(data, rng):
    try:
        tree = json.loads(data)
    except ValueError:
        return damage.text_of(data, rng)
    for _ in range(rng.choice([1, 1, 2, 3])):
        change_json(tree, rng)
    return json.dumps(tree).encode()


def glb(data, rng):
    """Other JSON in a container that holds together, or a container whose sizes do not."""
    size = struct.unpack_from("<I", data, 12)[0]
    text, rest = data[20:20 + size], data[20 + size:]
    if rng.random() < 0.3:
        return damage.poke(data, rng.choice([4, 8, 12, 16, 20 + size]),
                           struct.pack("<I", rng.choice(damage.NUMBERS) & 0xffffffff))
    text = gltf(text.rstrip(b" "), rng)
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + rest
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def jpeg(data, rng):
    """Other sizes and tables in the segments before the scan."""
    segments, at = [], 2
    while at + 4 <= len(data) and data[at] == 0xff and data[at + 1] != 0xda:
        segments.append((at, struct.unpack_from(">H", data, at + 2)[0]))
        at += 2 + segments[-1][1]
    if not segments:
        return damage.bytes_of(data, rng)
    at, size = rng.choice(segments)
    place = at + rng.randrange(2, 2 + max(size, 1))
    return damage.poke(data, place, rng.choice([b"\0", b"\xff", b"\xff\xff", b"\0\0", bytes([rng.randrange(256)])]))


def tiff(data, rng):
    """Another value, count or type of an entry of the first directory."""
    order = "<" if data[:2] == b"II" else ">"
    begin = struct.unpack_from(order + "I", data, 4)[0]
    if begin + 2 > len(data):
        return damage.bytes_of(data, rng)
    entry = begin + 2 + 12 * rng.randrange(max(1, struct.unpack_from(order + "H", data, begin)[0]))
    value = rng.choice(damage.NUMBERS)
    if rng.random() < 0.7:
        return damage.poke(data, entry + rng.choice([4, 8, 8, 8]), struct.pack(order + "I", value & 0xffffffff))
    return damage.poke(data, entry + rng.choice([0, 2]), struct.pack(order + "H", value & 0xffff))


# What keeps the structure of files whose names end so; text formats keep their tokens.
BY_ENDING = {".png": png, ".hdr": hdr, ".exr": exr, ".ply": ply, ".gltf": gltf, ".glb": glb, ".jpg": jpeg,
             ".jpeg": jpeg, ".tif": tiff, ".tiff": tiff, ".tx": tiff, ".vdb": vdb_fields.vdb,
             ".obj": damage.text_of, ".mtl": damage.text_of, ".chan": damage.text_of, ".txt": damage.text_of,
             ".toml": damage.text_of, ".ies": damage.text_of, ".csv": damage.text_of}


def damaged(name, data, rng):
    """A damaged copy of a file: half of the time by its format, else by bytes."""
    by_format = BY_ENDING.get(name[name.rfind("."):])
    if by_format and rng.random() < 0.6:
        try:
            data = by_format(data, rng)
            return data if rng.random() < 0.8 else damage.bytes_of(data, rng)
        except (ValueError, IndexError, struct.error):
            pass  # the base file is of another form: bytes will do
    return damage.bytes_of(data, rng)
