"""R, G, B of the plain EXR files that vdbeam and its peers write: scanlines, ZIP or no compression, half or float,
data window = display window. `vdbeam compare` reads the rest."""

import struct
import zlib

import numpy as np

from .report import ReportError

_TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
_LINES = {0: 1, 2: 1, 3: 16}  # compression -> scanlines of a chunk


def _text(data, position):
    end = data.index(b"\0", position)
    return data[position:end].decode("latin-1"), end + 1


def _attributes(data):
    """The header's attributes as bytes, and where it ends."""
    position, attributes = 8, {}
    while data[position]:
        name, position = _text(data, position)
        _, position = _text(data, position)
        (size,) = struct.unpack_from("<i", data, position)
        attributes[name] = data[position + 4:position + 4 + size]
        position += 4 + size
    return attributes, position + 1


def _channels(data):
    position, channels = 0, []
    while data[position]:
        name, position = _text(data, position)
        kind, _, x_sampling, y_sampling = struct.unpack_from("<iiii", data, position)
        if (x_sampling, y_sampling) != (1, 1):
            raise ValueError("it has subsampled channels")
        channels.append((name, _TYPES[kind]))
        position += 16
    return channels


def _unzip(chunk, size):
    if len(chunk) == size:  # stored as it is where compression does not pay
        return chunk
    raw = np.frombuffer(zlib.decompress(chunk), np.uint8)
    # Undo the predictor, then the split into even and odd bytes.
    raw = (np.cumsum(raw.astype(np.int64)) - 128 * np.arange(len(raw))).astype(np.uint8)
    half = (len(raw) + 1) // 2
    result = np.empty_like(raw)
    result[0::2], result[1::2] = raw[:half], raw[half:]
    return result.tobytes()


def read_rgb(path):
    """An array [height, width, 3] of floats. Raises ReportError."""
    try:
        with open(path, "rb") as file:
            return _decode(file.read())
    except (OSError, ValueError, KeyError, IndexError, struct.error, zlib.error) as error:
        raise ReportError(f"{path}: not an EXR that can be shown: {error}") from error


def _decode(data):
    if data[:4] != b"\x76\x2f\x31\x01" or data[5] & ~4:  # 4: names may be long
        raise ValueError("not a plain EXR of scanlines")
    attributes, position = _attributes(data)
    if attributes["dataWindow"] != attributes["displayWindow"]:
        raise ValueError("it is cropped")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = _channels(attributes["channels"])
    lines = _LINES[attributes["compression"][0]]
    image = np.zeros((height, width, 3), np.float32)
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, position):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, y1 + 1 - y)
        line_size = width * sum(kind.itemsize for _, kind in channels)
        chunk = _unzip(data[offset + 8:offset + 8 + size], rows * line_size)
        start = 0
        for row in range(y - y0, y - y0 + rows):
            for name, kind in channels:  # a line holds its channels one after another
                if name in ("R", "G", "B"):
                    image[row, :, "RGB".index(name)] = np.frombuffer(chunk, kind, width, start)
                start += width * kind.itemsize
    return image


def capture_date(path):
    """The day on which an image was written, as YYYY-MM-DD, from its capDate; None without one."""
    try:
        with open(path, "rb") as file:
            return _attributes(file.read())[0]["capDate"][:10].decode("ascii").replace(":", "-")
    except (OSError, ValueError, KeyError, IndexError, struct.error):
        return None


def write_rgb(path, image):
    """Writes an array [height, width, 3] as floats, without compression."""
    height, width, _ = image.shape

    def attribute(name, kind, data):
        return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(data)) + data

    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R"))
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = (b"\x76\x2f\x31\x01\x02\0\0\0" + attribute("channels", "chlist", channels + b"\0")
              + attribute("compression", "compression", b"\0") + attribute("dataWindow", "box2i", window)
              + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
              + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
              + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
              + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")
    lines = [struct.pack("<ii", y, 12 * width) + row.T[::-1].astype("<f4").tobytes()
             for y, row in enumerate(image)]
    first = len(header) + 8 * height
    offsets = struct.pack(f"<{height}Q", *(first + y * len(lines[0]) for y in range(height)))
    with open(path, "wb") as file:
        file.write(header + offsets + b"".join(lines))
