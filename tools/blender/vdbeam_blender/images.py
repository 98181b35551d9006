"""Finds the files of Blender's images, and writes those of images that only Blender holds or vdbeam does not read.
Images are what has Blender's attributes; bpy itself is not imported."""
import hashlib
import os
import struct
import zlib

import numpy

from . import exr, sequence

# First bytes of the files that vdbeam reads, with the ending of a copy.
KINDS = {b"\x89PNG": ".png", b"\xff\xd8\xff": ".jpg", b"\x76\x2f\x31\x01": ".exr", b"#?": ".hdr"}
# Sources of images that are no single image: films, tiles, results of renders.
OTHER_SOURCES = {"MOVIE", "TILED", "VIEWER"}
PREFIX = "image_"


def kind_of(start):
    """The ending of a file that begins with these bytes; None where vdbeam does not read it."""
    return next((ending for magic, ending in KINDS.items() if start.startswith(magic)), None)


def own_file(image, abspath):
    """The path of an image's own file, where vdbeam reads it, else None."""
    if image.source not in ("FILE", "SEQUENCE") or not image.filepath:
        return None
    path = abspath(image.filepath)
    try:
        with open(path, "rb") as file:
            return path if kind_of(file.read(4)) else None
    except OSError:
        return None


def pixels_of(image):
    """The pixels of an image, as float32 of (height, width, channels) with row 0 at the top; None without any."""
    width, height = image.size
    if width < 1 or height < 1:
        return None
    pixels = numpy.empty(width * height * image.channels, numpy.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, image.channels)[::-1]
    opaque = image.channels == 4 and bool((pixels[..., 3] == 1).all())
    return pixels[..., :3] if opaque else pixels


def png_bytes(pixels):
    """A PNG of 8 bits per channel of pixels in [0, 1]."""
    height, width, channels = pixels.shape
    codes = numpy.rint(255 * pixels.clip(0, 1)).astype(numpy.uint8).reshape(height, width * channels)
    lines = numpy.hstack([numpy.zeros((height, 1), numpy.uint8), codes])  # each line begins with its filter: none
    colour_type = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    parts = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)),
             (b"IDAT", zlib.compress(lines.tobytes(), 1)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in parts)


def write_exr(path, pixels):
    """Writes pixels of 1 to 4 channels as an EXR."""
    letters = {1: "RGB", 2: "RGBA", 3: "RGB", 4: "RGBA"}[pixels.shape[2]]
    colours = pixels.shape[2] - (len(letters) == 4)
    exr.write(path, {letter: pixels[..., -1 if letter == "A" else min(index, colours - 1)]
                     for index, letter in enumerate(letters)})


def written(image, folder, content, ending, write):
    """The name of a file in the folder that `write` fills unless it is there; it has a hash of the content."""
    name = f"{PREFIX}{sequence.safe_name(image.name)}_{hashlib.sha256(content).hexdigest()[:12]}{ending}"
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        write(path)
    return name


def write_bytes(path, data):
    """Writes a file."""
    with open(path, "wb") as file:
        file.write(data)


def file_of(image, folder, abspath):
    """The file of an image as vdbeam reads it: its own one, a copy of the packed one, or its pixels, as an EXR where
    they are floats and else as a PNG; None without any. Pixels that were painted and not saved count."""
    if image is None or image.source in OTHER_SOURCES:
        return None
    packed = None if image.is_dirty or image.packed_file is None else image.packed_file.data
    if packed is not None and kind_of(packed):
        return written(image, folder, packed, kind_of(packed), lambda path: write_bytes(path, packed))
    if packed is None and not image.is_dirty and (path := own_file(image, abspath)):
        return path
    pixels = pixels_of(image) if image.source != "SEQUENCE" else None
    if pixels is None:
        return None
    content = repr(pixels.shape).encode() + pixels.tobytes()
    if image.is_float:
        return written(image, folder, content, ".exr", lambda path: write_exr(path, pixels))
    return written(image, folder, content, ".png", lambda path: write_bytes(path, png_bytes(pixels)))


class ImageFiles:
    """The files of the images of a scene, by their names, found once until they are forgotten."""

    def __init__(self, folder, abspath):
        self.folder = folder
        self.abspath = abspath
        self.known = {}

    def forget(self):
        """Images are looked at again: they may have been painted."""
        self.known.clear()

    def path(self, image):
        """The file of an image, or None."""
        if image is None:
            return None
        if image.name_full not in self.known:
            self.known[image.name_full] = file_of(image, self.folder, self.abspath)
        return self.known[image.name_full]
