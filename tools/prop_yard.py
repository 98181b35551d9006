"""Meshes and textures of the gallery's yard: sets, brick walls, a drum and a ladder. Lengths are in metres, y is up.

A stone takes a small piece of its texture, from a place that its tone decides, so that no two stones are equal.
"""
import math
import random

from prop_buildings import add_crate
from prop_mesh import Mesh, waves


class Masonry(Mesh):
    """Stones with chamfered edges on a plane, and their texture coordinates."""

    def __init__(self, seed):
        super().__init__()
        self.dice, self.coordinates = random.Random(seed), []

    def stone(self, place, low, high, tone, edge=0.008, depth=0.05, dome=0.0, rough=0.002):
        """A stone over the rectangle from `low` to `high`. `place(a, b, up)` gives the points; `tone` from 0 to 1."""
        dice = self.dice
        corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
        middle = [(low[k] + high[k]) / 2 for k in (0, 1)]
        up = dice.gauss(0, rough)
        tilt = [dice.gauss(0, 1.5 * rough) / (high[k] - low[k] + 0.05) for k in (0, 1)]
        lift = lambda a, b: up + tilt[0] * (a - middle[0]) + tilt[1] * (b - middle[1])
        uneven = lambda: dice.uniform(-0.3, 0.3) * edge
        rings = [[(a + uneven(), b + uneven(), -depth) for a, b in corners]]
        rings.append([(a, b, lift(a, b) - edge) for a, b, _ in rings[0]])
        inner = [(a + math.copysign(edge, middle[0] - a), b + math.copysign(edge, middle[1] - b)) for a, b in corners]
        rings.append([(a + uneven(), b + uneven(), lift(a, b)) for a, b in inner])
        points = [point for ring in rings for point in ring] + [(*middle, lift(*middle) + dome)]
        faces = [(4 * r + i, 4 * r + (i + 1) % 4, 4 * r + 4 + (i + 1) % 4, 4 * r + 4 + i) for r in (0, 1) for i in range(4)]
        faces += [(8 + i, 8 + (i + 1) % 4, 12) for i in range(4)]
        self.add([place(*point) for point in points], faces)
        u, v = dice.random(), 0.04 + 0.9 * min(max(tone, 0), 1)
        self.coordinates += [(u + 0.5 * (a - middle[0]), v + 0.25 * (b - middle[1])) for a, b, _ in points]

    def write(self, path):
        lines = [f"v {x:.5g} {y:.5g} {z:.5g}" for x, y, z in self.points]
        lines += [f"vt {u:.4f} {v:.4f}" for u, v in self.coordinates]
        lines += ["f " + " ".join(f"{i}/{i}" for i in face) for face in self.faces]
        path.write_text("\n".join(lines) + "\n")


def make_paving():
    """Granite sets in rows over x from -10 to 10 and z from -6.2 to 7.5; their tops are at y = 0."""
    mesh, stains, wear = Masonry(71), waves(72, 9, 0.7), waves(73, 6, 0.6)
    length, width, joint = 0.19, 0.12, 0.01
    for row in range(int(13.7 / width)):
        z = -6.2 + row * width
        x = -10 - length * mesh.dice.random()
        while x < 10:
            size = length * mesh.dice.uniform(0.75, 1.15)
            tone = 0.5 + 0.17 * stains(0.9 * x, 0.9 * z) + mesh.dice.gauss(0, 0.13)
            sunk = 0.005 * wear(0.5 * x, 0.5 * z)
            mesh.stone(lambda a, b, up, sunk=sunk: (a, up + sunk, -b), (x, -z - width + joint), (x + size - joint, -z), tone,
                       edge=0.01, dome=0.006, rough=0.002)
            x += size
    return mesh


# Openings of the wall at the back, as (left, sill, right, top).
OPENINGS = [(-7.6, 1.52, -6.2, 3.56), (-4.9, 1.52, -3.5, 3.56), (-2.2, 0, 0.4, 3.22), (1.7, 1.52, 3.1, 3.56), (4.4, 1.52, 5.8, 3.56)]


def add_bricks(mesh, place, length, height, openings, dirt):
    """Courses of bricks over (along, up) without the openings; `dirt(along, up)` darkens them."""
    brick, course, joint = 0.25, 0.0765, 0.011
    for row in range(int(height / course)):
        up = row * course
        along = -brick * (0.5 if row % 2 else 0)
        while along < length:
            pieces = [(max(along, 0), min(along + brick - joint, length))]
            for left, sill, right, top in openings:
                if up + course > sill + 0.02 and up < top - 0.02:
                    pieces = [part for low, high in pieces for part in ((low, min(high, left)), (max(low, right), high))]
            tone = 0.55 - dirt(along, up) + mesh.dice.gauss(0, 0.12)
            for low, high in pieces:
                if high - low > 0.03:
                    mesh.stone(place, (low, up), (high, up + course - joint), tone, edge=0.004, depth=0.1, rough=0.0016)
            along += brick


def make_bricks():
    """The wall at the back, in z = -6 with x from -9 to 7 and 5.6 high; the end of a wing at x = -7 on the left; a low wall
    at the right."""
    mesh, grime = Masonry(74), waves(75, 8, 0.6)

    def dirt(along, up):
        foot = 0.22 * math.exp(-up / 0.35)
        streak = 0.16 * max(grime(2.2 * along, 0.25 * up), 0)
        return foot + streak + 0.1 * grime(0.7 * along, 0.8 * up)

    add_bricks(mesh, lambda a, b, up: (a - 9, b, -6 + up), 16, 5.6, [(a + 9, b, c + 9, d) for a, b, c, d in OPENINGS], dirt)
    add_bricks(mesh, lambda a, b, up: (7 + a, b, -5.9 + up), 6, 2.3, [], dirt)
    add_bricks(mesh, lambda a, b, up: (-7 + up, b, 3 - a), 9, 4.2, [], dirt)
    return mesh


def make_mortar():
    """The joints: faces behind the bricks."""
    mesh = Mesh()
    edges = [-8.99] + [x for left, _, right, _ in OPENINGS for x in (left, right)] + [6.99]
    for i in range(0, len(edges), 2):
        mesh.box((edges[i], 0, -6.4), (edges[i + 1], 5.6, -6.009))
    for left, sill, right, top in OPENINGS:
        if sill > 0:
            mesh.box((left, 0, -6.4), (right, sill, -6.009))
        mesh.box((left, top, -6.4), (right, 5.6, -6.009))
    mesh.box((7.01, 0, -6.2), (13, 2.3, -5.909))
    mesh.box((-10, 0, -6), (-7.009, 4.2, 2.99))
    return mesh


def make_stonework():
    """What is of pale stone: lintels, sills, copings."""
    mesh = Mesh()
    for left, sill, right, top in OPENINGS:
        if sill > 0:
            mesh.box((left - 0.12, sill - 0.1, -6.3), (right + 0.12, sill, -5.93))
        mesh.box((left - 0.18, top, -6.3), (right + 0.18, top + 0.23, -5.985))
    mesh.box((-9.1, 5.6, -6.5), (7.1, 5.74, -5.86))
    mesh.box((-9.1, 4.9, -6.3), (7.05, 5.0, -5.95))
    mesh.box((7, 2.3, -6.25), (13, 2.4, -5.84))
    mesh.box((-10, 4.2, -6), (-6.9, 4.32, 3.1))
    return mesh


def make_joinery():
    """Frames of the windows, a gate of planks, and a gate of planks."""
    mesh, dice = Mesh(), random.Random(76)
    for left, sill, right, top in OPENINGS:
        back, front = -6.2, -6.13
        if sill == 0:
            planks = 14
            for i in range(planks):
                low = left + (right - left) * i / planks
                out = dice.uniform(0, 0.012)
                mesh.box((low + 0.004, 0.03, back), (low + (right - left) / planks - 0.004, top, front + out))
            for y in (0.35, 1.6, 2.85):
                mesh.box((left, y, front), (right, y + 0.15, front + 0.04))
            continue
        for i in range(5):
            x = left + (right - left) * i / 4
            half = 0.035 if i in (0, 4) else 0.016
            mesh.box((max(x - half, left), sill, back), (min(x + half, right), top, front))
        for i in range(6):
            y = sill + (top - sill) * i / 5
            half = 0.035 if i in (0, 5) else 0.016
            mesh.box((left, max(y - half, sill), back + 0.01), (right, min(y + half, top), front - 0.01))
    return mesh


def make_ladder():
    """A ladder of wood that leans on the wall between two windows."""
    mesh, foot, top = Mesh(), (0.95, -4.9), (0.95, -5.92)
    height, width = 4.3, 0.42

    def at(t, side, out):
        return foot[0] + side, t * height, foot[1] + t * (top[1] - foot[1]) + out

    def bar(low, high, size):
        points = [tuple(p[k] + d[k] for k in range(3)) for p in (low, high)
                  for d in ((-size, 0, -size), (size, 0, -size), (size, 0, size), (-size, 0, size))]
        mesh.add(points, [(0, 1, 2, 3), (4, 7, 6, 5)] + [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)])

    for side in (0, width):
        bar(at(0, side, 0), at(1, side, 0), 0.024)
    for i in range(1, 15):
        y = i / 15
        low, high = at(y, 0, 0), at(y, width, 0)
        mesh.box((low[0], low[1] - 0.014, low[2] - 0.014), (high[0], high[1] + 0.014, high[2] + 0.014))
    return mesh


def make_drum():
    """An open steel drum, 0.58 wide and 0.88 high, with its foot at the origin."""
    part, mesh, profile = Mesh(), Mesh(), [(0.001, 0.02), (0.28, 0.02), (0.288, 0.0), (0.29, 0.02)]
    for low in (0.3, 0.58):
        profile += [(0.286, low - 0.03), (0.286, low - 0.016), (0.296, low), (0.286, low + 0.016), (0.286, low + 0.03)]
    profile += [(0.286, 0.855), (0.294, 0.868), (0.288, 0.88), (0.28, 0.868), (0.28, 0.06), (0.001, 0.06)]
    part.revolve(profile, 72)
    dent = waves(77, 5, 0.5)
    mesh.add([(x * (1 + 0.012 * dent(3 * x, 4 * z)), z, -y * (1 + 0.012 * dent(3 * y + 5, 4 * z))) for x, y, z in part.points],
             [[i - 1 for i in face] for face in part.faces])
    return mesh


def make_boxes():
    """Crates in the yard, three on the right and one near the gate."""
    mesh = Mesh()
    for x, y, z, size, turn in ((3.3, 0, -4.9, 0.95, 0.12), (4.4, 0, -5.1, 0.85, -0.15), (3.5, 0.95, -4.95, 0.7, 0.6),
                                (-2.9, 0, -4.9, 0.8, 0.1)):
        add_crate(mesh, x, y, z, size, turn)
    return mesh


def stone_texture(dark, pale, speckle, seed, size=1024):
    """8-bit RGB of stones, from dark at the bottom to pale at the top, with spots and grain; its left and right join."""
    import numpy as np  # all other props do without it

    dice = np.random.default_rng(seed)

    def noise(scale):
        """Noise of this many cells, interpolated, from -1 to 1."""
        cells = dice.uniform(-1, 1, (scale, scale))
        at = np.arange(size) * scale / size
        low, part = at.astype(int), at % 1
        part = part * part * (3 - 2 * part)
        rows = cells[low] * (1 - part)[:, None] + cells[(low + 1) % scale] * part[:, None]
        return rows[:, low] * (1 - part) + rows[:, (low + 1) % scale] * part

    level = np.linspace(1, 0, size)[:, None] + 0.12 * noise(16) + 0.05 * noise(64)
    level = np.clip(level, 0, 1)[..., None]
    colour = np.array(dark) * (1 - level) + np.array(pale) * level
    hue = 0.06 * noise(12)[..., None] * np.array([1, 0, -1])
    grain = 1 + speckle * (0.6 * noise(256) + 0.6 * dice.uniform(-1, 1, (size, size)))
    return (255 * np.clip(colour * (1 + hue) * grain[..., None], 0, 1) + 0.5).astype(np.uint8)
