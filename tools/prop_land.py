"""Meshes of the gallery: land, sea, a ruin and fish."""
import math
import random

from prop_mesh import Mesh, waves


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


def make_woods():
    """Hedges and small woods of round trees 8 to 16 m high, over 12 x 12 km; lengths are in kilometres."""
    dice, mesh = random.Random(12), Mesh()
    wood = waves(21, 10, 0.5)

    def tree(x, z, size):
        half = size * dice.uniform(0.28, 0.5)
        rings = [(0.25 * half, 0.08), (half, 0.3), (0.85 * half, 0.62), (0.4 * half, 0.88)]
        turn = dice.random()
        points = [(x + r * dice.uniform(0.75, 1.2) * math.cos(2 * math.pi * (i / 6 + turn)), size * h,
                   z + r * dice.uniform(0.75, 1.2) * math.sin(2 * math.pi * (i / 6 + turn)))
                  for r, h in rings for i in range(6)] + [(x, size, z)]
        faces = [(6 * ring + i, 6 * ring + 6 + i, 6 * ring + 6 + (i + 1) % 6, 6 * ring + (i + 1) % 6)
                 for ring in range(3) for i in range(6)]
        mesh.add(points, faces + [(18 + i, 24, 18 + (i + 1) % 6) for i in range(6)])

    for _ in range(110):                # hedges
        x, z, angle, length = dice.uniform(-6, 6), dice.uniform(-6, 6), dice.choice((0.2, 1.75)), dice.uniform(0.2, 1.1)
        for i in range(int(length / 0.014)):
            away = 0.014 * i + dice.uniform(-0.006, 0.006)
            if dice.random() < 0.85:
                tree(x + away * math.cos(angle), z + away * math.sin(angle) + dice.uniform(-0.003, 0.003),
                     dice.uniform(0.006, 0.013))
    for _ in range(26000):              # woods
        x, z = dice.uniform(-6, 6), dice.uniform(-6, 6)
        if wood(0.45 * x, 0.9 * z) > 0.62:
            tree(x, z, dice.uniform(0.009, 0.017))
    return mesh


def make_rock():
    """A rock in the sea for the lighthouse of data/lighthouse, whose tower stands at the origin, with its foot at
    y = -0.8; the sea is at y = -1.2."""
    coarse, fine, cracks = waves(31, 6, 0.5), waves(32, 16, 0.8), waves(33, 8, 0.4)

    def place(u, v):
        x, z = 4.4 * (u - 0.5), 3.6 * (v - 0.5)
        away = math.hypot(x / 1.35, z) * (1 + 0.22 * coarse(1.5 * x, 1.5 * z))
        ridge = 1 - abs(fine(2.2 * x, 2.9 * z))
        cliff = 0.5 - 0.62 * max(away - 0.38, 0) ** 0.8
        rough = 0.22 * min(max(away - 0.33, 0) / 0.25, 1)
        y = cliff + rough * (ridge - 0.7) + 0.3 * rough * cracks(6 * x, 6 * z)
        step = 0.09
        level = math.floor(y / step)
        part = y / step - level
        return x, -1.22 + step * (level + min(max((part - 0.3) / 0.4, 0), 1)) * 0.6 + 0.4 * y, z

    mesh = Mesh()
    mesh.grid(260, 220, place)
    return mesh


def make_cottage():
    """The keeper's house beside the lighthouse: walls, a gable roof and a chimney; its windows are in the scene."""
    mesh = Mesh()
    mesh.box((-0.17, -0.8, -0.1), (0.17, -0.56, 0.1))
    mesh.add([(-0.19, -0.565, -0.12), (-0.19, -0.565, 0.12), (-0.19, -0.44, 0), (0.19, -0.565, -0.12), (0.19, -0.565, 0.12),
              (0.19, -0.44, 0)], [(0, 1, 2), (3, 5, 4), (1, 4, 5, 2), (0, 2, 5, 3), (0, 3, 4, 1)])
    mesh.box((0.09, -0.5, -0.03), (0.14, -0.39, 0.03))
    return mesh


def make_sea():
    """Waves over 40 x 24 about the origin, at most 0.02 high, finest towards +z."""
    wave, ripple = waves(41, 9, 0.9), waves(42, 12, 0.6)

    def place(u, v):
        z = 6 - 24 * (1 - v) ** 1.7
        x = 40 * (u - 0.5)
        return x, 0.016 * wave(0.7 * x + 0.3 * z, 1.5 * z) + 0.006 * ripple(2.5 * x, 5 * z), z

    mesh = Mesh()
    mesh.grid(420, 330, place)
    return mesh


def make_seabed():
    """Sand with ripples, 16 x 16 about the origin, at y = 0."""
    dunes, ripple = waves(51, 6, 0.9), waves(52, 5, 0.2)

    def place(u, v):
        x, z = 16 * (u - 0.5), 16 * (v - 0.5)
        bend = dunes(0.5 * x, 0.5 * z)
        return x, 0.16 * bend + 0.016 * math.sin(16 * (0.35 * x + z) + 5 * bend) * (0.6 + 0.4 * ripple(x, z)), z

    mesh = Mesh()
    mesh.grid(300, 300, place)
    return mesh


def make_ruin():
    """Three standing columns and two fallen drums on the seabed; y is up."""
    mesh = Mesh()

    def column(x, z, height, lean, lying):
        part, sides = Mesh(), 80
        profile = [(0.001, 0)]
        if not lying:
            profile += [(0.42, 0), (0.42, 0.12), (0.37, 0.14), (0.39, 0.2), (0.33, 0.25)]
        profile += [(0.28, 0.3 if not lying else 0)] + [(0.28 - 0.02 * i / 12, 0.3 + (height - 0.3) * i / 12) for i in range(1, 13)]
        part.revolve(profile + [(0.001, height - 0.03)], sides)
        rough = waves(int(100 * x) % 97, 8, 0.5)
        points = []
        for i, (px, py, pz) in enumerate(part.points):
            angle = 2 * math.pi * (i % sides) / sides
            shaft = pz > 0.29 or lying
            flute = 1 - 0.05 * abs(math.sin(6 * angle)) ** 2 if shaft else 1
            wear = 1 + 0.02 * rough(3 * pz, 2 * math.cos(angle))
            top = 0.09 * rough(2 * px + 7, 3 * py) if i // sides > len(profile) - 3 else 0
            px, py, pz = px * flute * wear, py * flute * wear, pz + top
            if lying:
                c, s = math.cos(lean), math.sin(lean)
                points.append((x + c * pz - s * px, 0.2 + py, z + s * pz + c * px))
            else:
                points.append((x + px + math.sin(lean) * pz, pz * math.cos(lean) - 0.08, z + py))
        mesh.add(points, [[i - 1 for i in face] for face in part.faces])

    column(-1.5, -0.6, 2.3, 0.03, False)
    column(-0.1, -2.2, 2.75, -0.02, False)
    column(1.6, -3.6, 1.5, 0.05, False)
    column(0.5, -0.5, 1.05, 0.5, True)
    column(1.75, -1.9, 0.8, -0.7, True)
    return mesh


def make_fish():
    """A shoal that swims along -x."""
    dice, mesh = random.Random(61), Mesh()
    for _ in range(46):
        x, y, z = dice.gauss(0, 0.6), dice.gauss(0, 0.16), dice.gauss(0, 0.5)
        size, turn = dice.uniform(0.06, 0.1), dice.gauss(0, 0.2)
        sides, rings = 10, [(-1, 0.02), (-0.8, 0.17), (-0.4, 0.3), (0, 0.31), (0.4, 0.2), (0.75, 0.06), (0.8, 0.05)]
        points = [(a, r * math.cos(2 * math.pi * i / sides), 0.4 * r * math.sin(2 * math.pi * i / sides))
                  for a, r in rings for i in range(sides)]
        faces = [(ring * sides + i, ring * sides + (i + 1) % sides, (ring + 1) * sides + (i + 1) % sides, (ring + 1) * sides + i)
                 for ring in range(len(rings) - 1) for i in range(sides)]
        tail = len(points)
        points += [(0.75, 0.03, 0), (1.15, 0.27, 0.02), (1.0, 0, 0), (1.15, -0.27, -0.02), (0.75, -0.03, 0)]
        faces += [(tail, tail + 1, tail + 2), (tail, tail + 2, tail + 4), (tail + 2, tail + 3, tail + 4)]
        c, s = math.cos(turn), math.sin(turn)
        mesh.add([(x + size * (c * a + s * d), y + size * b, z + size * (c * d - s * a)) for a, b, d in points], faces)
    return mesh
