#!/usr/bin/env python3
"""Makes the meshes and the texture of the gallery's scenes: hills, a chimney, windows, blocks, a patchwork of fields.

Usage: make_props.py FOLDER

The same files come out each time. Y is up, except in chimney.obj and blocks.obj, which stand in
simulations of Blender's.
"""
import math
import pathlib
import random
import struct
import sys
import zlib


class Mesh:
    def __init__(self):
        self.points, self.faces = [], []

    def add(self, points, faces):
        first = len(self.points) + 1
        self.points += points
        self.faces += [[first + i for i in face] for face in faces]

    def box(self, low, high):
        points = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        self.add(points, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])

    def revolve(self, profile, sides=64):
        """Turns the profile, a list of (radius, height), about the Z axis."""
        points = [(r * math.cos(2 * math.pi * i / sides), r * math.sin(2 * math.pi * i / sides), z)
                  for r, z in profile for i in range(sides)]
        self.add(points, [(ring * sides + i, ring * sides + (i + 1) % sides, (ring + 1) * sides + (i + 1) % sides,
                           (ring + 1) * sides + i) for ring in range(len(profile) - 1) for i in range(sides)])

    def grid(self, columns, rows, place):
        """A sheet of (columns + 1) x (rows + 1) points place(u, v), with u and v from 0 to 1."""
        points = [place(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
        self.add(points, [(j * (columns + 1) + i, (j + 1) * (columns + 1) + i, (j + 1) * (columns + 1) + i + 1,
                           j * (columns + 1) + i + 1) for j in range(rows) for i in range(columns)])

    def write(self, path):
        lines = [f"v {x:.5g} {y:.5g} {z:.5g}" for x, y, z in self.points]
        lines += ["f " + " ".join(map(str, face)) for face in self.faces]
        path.write_text("\n".join(lines) + "\n")


def waves(seed, count, roughness):
    """A sum of sines in random directions, smaller ones with smaller amplitudes; about -1 to 1."""
    dice = random.Random(seed)
    terms = []
    for i in range(count):
        size, angle = 1.55 ** i, 2 * math.pi * dice.random()
        terms.append((size * math.cos(angle), size * math.sin(angle), 2 * math.pi * dice.random(), size ** -roughness))
    total = sum(term[3] for term in terms)
    return lambda x, y: sum(a * math.sin(kx * x + ky * y + phase) for kx, ky, phase, a in terms) / total * 1.8


def make_hills():
    """A coast of low hills, 60 wide and 16 deep, 0.4 high, falling to 0 towards the viewer (+z)."""
    height = waves(3, 14, 0.75)

    def place(u, v):
        x, z = 60 * (u - 0.5), 16 * (v - 0.5)
        shore = min(1, 3 * (1 - v), 4 * v)
        return x, 0.4 * shore * max(0.25 + height(0.35 * x, 0.6 * z), 0) - 0.02, z

    mesh = Mesh()
    mesh.grid(240, 64, place)
    return mesh


def make_chimney():
    """A brick chimney of height 1 and its rim."""
    mesh = Mesh()
    mesh.revolve([(0.16, 0), (0.115, 0.9), (0.135, 0.91), (0.135, 0.955), (0.11, 0.96), (0.108, 1), (0.09, 1), (0.09, 0.6),
                  (0, 0.6)])
    return mesh


def make_windows():
    """A wall in the plane x = 0 with three tall windows and their bars, so wide and high that the sun shines through those
    alone."""
    mesh = Mesh()
    mesh.box((-0.2, 5, -14), (0.2, 16, 9))
    edges = [-14, -3.3, -1.9, -0.7, 0.7, 1.9, 3.3, 9]
    for i in range(0, 7, 2):
        mesh.box((-0.2, 0, edges[i]), (0.2, 5, edges[i + 1]))
    for i in range(1, 7, 2):
        low, high = edges[i], edges[i + 1]
        mesh.box((-0.2, 0, low), (0.2, 1, high))
        mesh.box((-0.2, 4.3, low), (0.2, 5, high))
        middle = 0.5 * (low + high)
        mesh.box((-0.03, 1, middle - 0.04), (0.03, 4.3, middle + 0.04))
        for y in (1.8, 2.6, 3.4):
            mesh.box((-0.03, y - 0.04, low), (0.03, y + 0.04, high))
    return mesh


def write_plain(path):
    """A plain of 2000 x 2000, over which a texture is repeated every 40."""
    corners = [(-1000, 1000), (1000, 1000), (1000, -1000), (-1000, -1000)]
    lines = [f"v {x} 0 {z}" for x, z in corners] + ["vt 0 0", "vt 50 0", "vt 50 50", "vt 0 50", "f 1/1 2/2 3/3 4/4"]
    path.write_text("\n".join(lines) + "\n")


def make_blocks():
    """Blocks of concrete, 0.1 to 0.3 high, around a blast at (2.2, 2.2); Z is up."""
    dice, mesh = random.Random(2), Mesh()
    for i in range(26):
        angle, away = 2 * math.pi * dice.random(), dice.uniform(2.1, 4.6)
        x, y, half = 2.2 + away * math.cos(angle), 2.2 + away * math.sin(angle), dice.uniform(0.05, 0.13)
        mesh.box((x - half, y - half * dice.uniform(0.5, 1.5), 0), (x + half, y + half, half * dice.uniform(1, 2.4)))
    return mesh


def field_colour(kind, wave):
    soils = [(0.66, 0.62, 0.46), (0.70, 0.64, 0.49), (0.60, 0.60, 0.44), (0.72, 0.67, 0.53), (0.56, 0.58, 0.42), (0.67, 0.60, 0.47),
             (0.62, 0.62, 0.45)]
    return [c * (1 + 0.05 * wave) for c in soils[kind % len(soils)]]


def make_fields(path, size=1024):
    """A patchwork of dry fields with woods and a river, as an sRGB PNG."""
    dice, cells = random.Random(5), 60
    seeds = {(i, j): (i + dice.random(), j + dice.random(), dice.randrange(1000)) for i in range(cells) for j in range(cells)}
    wood, bend = waves(8, 12, 0.6), waves(9, 9, 1.1)
    rows = []
    for y in range(size):
        row = bytearray([0])
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

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(b"".join(rows), 9)) + chunk(b"IEND", b""))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.split("\n\n")[1])
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    make_hills().write(folder / "hills.obj")
    make_chimney().write(folder / "chimney.obj")
    make_windows().write(folder / "windows.obj")
    make_blocks().write(folder / "blocks.obj")
    write_plain(folder / "plain.obj")
    make_fields(folder / "fields.png")
    print(f"{folder}: hills.obj, chimney.obj, windows.obj, blocks.obj, plain.obj and fields.png written")


if __name__ == "__main__":
    main()
