#!/usr/bin/python3
"""Makes the meshes of the gallery's scenes, and their textures: a patchwork of fields, setts, bricks.

Usage: make_props.py FOLDER [--small]

The same files come out each time; with --small, fields.png has 64 x 64 pixels in place of 1024 x 1024, which are
most of the work. Y is up, except in chimney.obj, factory.obj, street.obj and rubble.obj, which stand around simulations
of Blender's.
"""
import pathlib
import random
import struct
import sys
import zlib

from prop_buildings import make_chimney, make_crates, make_factory, make_hall, make_people, make_rubble, make_street
from prop_land import make_cottage, make_fish, make_hills, make_rock, make_ruin, make_sea, make_seabed, make_woods
from prop_mesh import waves
from prop_yard import (make_boxes, make_bricks, make_drum, make_joinery, make_ladder, make_mortar, make_paving, make_stonework,
                       stone_texture)


def write_png(path, width, rows):
    """Writes rows of 8-bit RGB as an sRGB PNG."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows), 9)) + chunk(b"IEND", b""))


def write_plain(path):
    """A plain of 2000 x 2000, over which a texture is repeated every 40."""
    corners = [(-1000, 1000), (1000, 1000), (1000, -1000), (-1000, -1000)]
    lines = [f"v {x} 0 {z}" for x, z in corners] + ["vt 0 0", "vt 50 0", "vt 50 50", "vt 0 50", "f 1/1 2/2 3/3 4/4"]
    path.write_text("\n".join(lines) + "\n")


def field_colour(kind, wave):
    soils = [(0.66, 0.62, 0.46), (0.70, 0.64, 0.49), (0.60, 0.60, 0.44), (0.72, 0.67, 0.53), (0.56, 0.58, 0.42), (0.67, 0.60, 0.47),
             (0.62, 0.62, 0.45)]
    return [c * (1 + 0.05 * wave) for c in soils[kind % len(soils)]]


def make_fields(path, size):
    """A patchwork of dry fields with woods and a river, as an sRGB PNG."""
    dice, cells = random.Random(5), 60
    seeds = {(i, j): (i + dice.random(), j + dice.random(), dice.randrange(1000)) for i in range(cells) for j in range(cells)}
    wood, bend = waves(8, 12, 0.6), waves(9, 9, 1.1)
    rows = []
    for y in range(size):
        row = bytearray()
        for x in range(size):
            u, v = x / size * cells, y / size * cells
            near = min((seeds[i % cells, j % cells] for i in (int(u) - 1, int(u), int(u) + 1) for j in (int(v) - 1, int(v), int(v) + 1)),
                       key=lambda s: max(abs((s[0] - u + cells / 2) % cells - cells / 2) * 0.8,
                                         abs((s[1] - v + cells / 2) % cells - cells / 2)))
            colour = field_colour(near[2], wood(u, 2 * v))
            if wood(0.33 * u, 0.33 * v) > 0.75:
                colour = (0.46, 0.50, 0.37)
            if abs(x / size - 0.5 - 0.16 * bend(0.12 * v, 0.7)) < 0.0035:
                colour = (0.50, 0.56, 0.60)
            row += bytes(min(255, int(255 * c)) for c in colour)
        rows.append(bytes(row))
    write_png(path, size, rows)


MESHES = {
    "hills": make_hills, "woods": make_woods, "chimney": make_chimney, "factory": make_factory, "hall": make_hall,
    "crates": make_crates, "people": make_people, "rock": make_rock, "cottage": make_cottage, "sea": make_sea,
    "seabed": make_seabed, "ruin": make_ruin, "fish": make_fish, "street": make_street, "rubble": make_rubble,
    "paving": make_paving, "bricks": make_bricks, "mortar": make_mortar, "stonework": make_stonework, "joinery": make_joinery, "ladder": make_ladder,
    "drum": make_drum, "boxes": make_boxes,
}
TEXTURES = {
    "setts": {"dark": (0.27, 0.26, 0.25), "pale": (0.66, 0.64, 0.61), "speckle": 0.22, "seed": 81},
    "clay": {"dark": (0.20, 0.13, 0.11), "pale": (0.72, 0.43, 0.32), "speckle": 0.12, "seed": 82},
}


def main():
    small = sys.argv[2:] == ["--small"]
    if len(sys.argv) != 2 + small:
        sys.exit(__doc__.split("\n\n")[1])
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in MESHES.items():
        make().write(folder / f"{name}.obj")
    write_plain(folder / "plain.obj")
    make_fields(folder / "fields.png", 64 if small else 1024)
    for name, options in TEXTURES.items():
        pixels = stone_texture(**options)
        write_png(folder / f"{name}.png", pixels.shape[1], [row.tobytes() for row in pixels])
    print(f"{folder}: plain.obj, fields.png, {len(MESHES)} other meshes and {len(TEXTURES)} textures written")


if __name__ == "__main__":
    main()
