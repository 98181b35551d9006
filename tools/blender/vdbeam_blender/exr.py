"""Flat EXR files of scan lines: as vdbeam writes them (read) and as Blender's result loads them (write).

Blender's Python has no EXR reader of its own, and copying pixels through its API takes seconds at 1080p, while
RenderResult.load_from_file is fast but wants its own names of layers. NumPy comes with Blender.
"""
import struct
import zlib

import numpy

MAGIC = 20000630
LONG_NAMES = 0x400
MULTI_PART = 0x1000
NOT_FLAT = 0x200 | 0x800 | MULTI_PART  # tiles, deep data, parts
TYPES = {0: numpy.dtype("<u4"), 1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}
FLOAT = 2
RUN_LENGTHS = 1
# Lines of a chunk by compression: none, RLE (quick looks), ZIPS, ZIP.
LINES = {0: 1, RUN_LENGTHS: 1, 2: 1, 3: 16}


class ExrError(Exception):
    """The file is not one that `read` understands, with one line that says why."""


class Reader:
    """Bytes of a file, read from front to back."""

    def __init__(self, data):
        self.data = data
        self.place = 0

    def take(self, count):
        """The next `count` bytes."""
        if self.place + count > len(self.data):
            raise ExrError("the file is truncated")
        piece = self.data[self.place:self.place + count]
        self.place += count
        return piece

    def number(self, form):
        """The next number, of a `struct` format."""
        return struct.unpack("<" + form, self.take(struct.calcsize("<" + form)))[0]

    def text(self):
        """The next text, up to its 0."""
        end = self.data.find(b"\0", self.place)
        if end < 0:
            raise ExrError("the file is truncated")
        piece = self.take(end - self.place)
        self.take(1)
        return piece.decode("utf-8", "replace")


def read_header(reader):
    """Attributes by name, as bytes."""
    if reader.number("I") != MAGIC:
        raise ExrError("the file is not an EXR")
    if reader.number("I") & NOT_FLAT:
        raise ExrError("the file has tiles, parts or deep data")
    attributes = {}
    while name := reader.text():
        reader.text()  # type
        attributes[name] = reader.take(reader.number("I"))
    return attributes


def read_channels(data):
    """(name, dtype) of each channel in the order of the file."""
    reader = Reader(data)
    channels = []
    while name := reader.text():
        kind = reader.number("i")
        reader.take(4)  # linear
        if reader.number("i") != 1 or reader.number("i") != 1 or kind not in TYPES:
            raise ExrError(f"the channel {name} is of an unknown kind")
        channels.append((name, TYPES[kind]))
    return channels


def without_runs(data):
    """Bytes as they were before run-length encoding."""
    pieces, place = [], 0
    while place + 1 < len(data):
        count = data[place]
        if count > 127:  # a negative number: bytes as they are
            pieces.append(data[place + 1:place + 257 - count])
            place += 257 - count
        else:
            pieces.append(data[place + 1:place + 2] * (count + 1))
            place += 2
    return b"".join(pieces)


def unpacked(data, size, compression):
    """A chunk as it was before its compression."""
    if len(data) == size:
        return numpy.frombuffer(data, numpy.uint8)
    try:
        plain = without_runs(data) if compression == RUN_LENGTHS else zlib.decompress(data)
    except zlib.error as problem:
        raise ExrError(f"a chunk is damaged: {problem}") from problem
    packed = numpy.frombuffer(plain, numpy.uint8)
    if len(packed) != size:
        raise ExrError("a chunk has a wrong size")
    # Undo the predictor, then the split into low and high bytes.
    offsets = packed.astype(numpy.uint32)
    offsets[1:] += 128
    halves = (numpy.cumsum(offsets) & 0xff).astype(numpy.uint8)
    result = numpy.empty(size, numpy.uint8)
    half = (size + 1) // 2
    result[0::2] = halves[:half]
    result[1::2] = halves[half:]
    return result


def read(path):
    """Channels by name, as float32 arrays of (height, width) with row 0 at the top, and the data window
    (x0, y0, x1, y1), both ends included. Throws ExrError and OSError."""
    with open(path, "rb") as file:
        reader = Reader(file.read())
    attributes = read_header(reader)
    try:
        channels = read_channels(attributes["channels"])
        compression = attributes["compression"][0]
        window = struct.unpack("<4i", attributes["dataWindow"])
    except (KeyError, struct.error) as problem:
        raise ExrError("the header lacks what it must have") from problem
    if compression not in LINES:
        raise ExrError("the compression must be none, rle, zip or zips")
    width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
    line_size = sum(dtype.itemsize for _, dtype in channels) * width
    lines = LINES[compression]
    reader.take(8 * ((height + lines - 1) // lines))  # offsets of the chunks
    planes = {name: numpy.empty((height, width), numpy.float32) for name, _ in channels}
    for first in range(0, height, lines):
        count = min(lines, height - first)
        row = reader.number("i") - window[1]
        block = unpacked(reader.take(reader.number("I")), count * line_size, compression).reshape(count, line_size)
        start = 0
        for name, dtype in channels:
            size = dtype.itemsize * width
            part = numpy.ascontiguousarray(block[:, start:start + size])
            planes[name][row:row + count] = part.view(dtype)
            start += size
    return planes, window


def attribute(name, kind, data):
    """An attribute of a header."""
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(data)) + data


def write(path, planes):
    """Writes float32 planes of (height, width), row 0 at the top, by channel name, without compression."""
    names = sorted(planes, key=lambda name: name.encode())
    height, width = planes[names[0]].shape
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iIii", FLOAT, 0, 1, 1) for name in names) + b"\0"
    header = struct.pack("<II", MAGIC, 2 | LONG_NAMES) + b"".join([
        attribute("channels", "chlist", channels), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", box), attribute("displayWindow", "box2i", box),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))]) + b"\0"
    line = 4 * width * len(names)
    chunk = numpy.dtype([("y", "<i4"), ("size", "<u4"), ("data", "<f4", (len(names), width))])
    rows = numpy.empty(height, chunk)
    rows["y"] = numpy.arange(height)
    rows["size"] = line
    for index, name in enumerate(names):
        rows["data"][:, index] = planes[name]
    offsets = len(header) + 8 * height + numpy.arange(height, dtype="<u8") * chunk.itemsize
    with open(path, "wb") as file:
        file.write(header + offsets.astype("<u8").tobytes())
        rows.tofile(file)
