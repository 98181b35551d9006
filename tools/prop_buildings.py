"""Meshes of the gallery: buildings and what stands in them."""
import math
import random

from prop_mesh import Mesh


def make_chimney():
    """A brick chimney of height 1 and its rim."""
    mesh = Mesh()
    mesh.revolve([(0.16, 0), (0.115, 0.9), (0.135, 0.91), (0.135, 0.955), (0.11, 0.96), (0.108, 1), (0.09, 1), (0.09, 0.6),
                  (0, 0.6)])
    return mesh


def make_factory():
    """Halls with saw-tooth roofs, silos, a gallery on legs and a water tower around chimneys at (0.6, 0.8), (1.5, 1.3) and
    (-0.5, 1.7); Z is up."""
    mesh = Mesh()

    def hall(x, y, bays, bay, depth, wall, rise):
        mesh.box((x, y, 0), (x + bays * bay, y + depth, wall))
        for i in range(bays):
            low, high = x + i * bay, x + (i + 1) * bay
            points = [(low, y, wall), (low, y, wall + rise), (high, y, wall),
                      (low, y + depth, wall), (low, y + depth, wall + rise), (high, y + depth, wall)]
            mesh.add(points, [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2)])

    def drum(x, y, radius, low, high, roof, sides=28):
        part = Mesh()
        part.revolve([(radius, low), (radius, high), (0.12 * radius, high + roof), (0.001, high + roof)], sides)
        mesh.add([(x + p[0], y + p[1], p[2]) for p in part.points], [[i - 1 for i in face] for face in part.faces])

    hall(0.95, 0.3, 6, 0.3, 1.0, 0.3, 0.14)
    hall(-1.15, 0.5, 4, 0.36, 1.2, 0.38, 0.18)
    mesh.box((0.32, 0.45, 0), (0.9, 1.15, 0.62))
    mesh.box((-1.9, 0.8, 0), (-1.25, 1.6, 0.85))
    mesh.box((-1.75, 0.95, 0.85), (-1.45, 1.3, 1.0))
    for i in range(4):
        drum(2.98 + 0.3 * i, 0.75, 0.135, 0, 0.72, 0.07)
    mesh.box((2.85, 0.68, 0.79), (4.05, 0.82, 0.86))
    drum(-2.45, 0.7, 0.2, 0.62, 0.86, 0.12)
    for i in range(5):
        angle = 2 * math.pi * i / 5
        x, y = -2.45 + 0.16 * math.cos(angle), 0.7 + 0.16 * math.sin(angle)
        mesh.box((x - 0.012, y - 0.012, 0), (x + 0.012, y + 0.012, 0.64))
    for i in range(8):                                # masts along the road and their wires
        x = -4.6 + 1.25 * i
        mesh.box((x - 0.012, -0.512, 0), (x + 0.012, -0.488, 0.62))
        mesh.box((x - 0.09, -0.506, 0.55), (x + 0.09, -0.494, 0.565))
        for j in range(10):
            t, u = j / 10, (j + 1) / 10
            sag = [0.57 - 0.3 * k * (1 - k) for k in (t, u)]
            for side in (-0.08, 0.08):
                ends = [(x + 1.25 * t + side, -0.5, sag[0]), (x + 1.25 * u + side, -0.5, sag[1])]
                mesh.add([(px, py + dy, pz + dz) for px, py, pz in ends
                          for dy, dz in ((-0.002, 0), (0.002, 0), (0, 0.004))],
                         [(0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)])
    mesh.box((0.9, 0.7, 0.42), (1.2, 0.78, 0.5))
    mesh.box((2.6, 0.72, 0.5), (3.0, 0.8, 0.58))
    return mesh


def make_hall():
    """A hall 12 wide, 10 high and 28 deep (x, y, z), with five tall windows in the wall x = 0 and pillars before them."""
    mesh, middles = Mesh(), (-13.2, -9.6, -6, -2.4, 1.2)
    low, high, half = 2.2, 8.4, 1.0
    mesh.box((-0.6, 0, -18), (0, low, 12))
    mesh.box((-0.6, high, -18), (0, 11, 12))
    edges = [-18] + [z + side * half for z in middles for side in (-1, 1)] + [12]
    for i in range(0, len(edges), 2):
        mesh.box((-0.6, low, edges[i]), (0, high, edges[i + 1]))
    for z in middles:
        for i in range(1, 4):
            at = z - half + 0.5 * half * i
            mesh.box((-0.33, low, at - 0.035), (-0.27, high, at + 0.035))
        for i in range(1, 6):
            at = low + (high - low) * i / 6
            mesh.box((-0.33, at - 0.035, z - half), (-0.27, at + 0.035, z + half))
        mesh.box((0, low - 0.16, z - half - 0.1), (0.16, low, z + half + 0.1))
    for z in [z - 1.8 for z in middles] + [3]:
        mesh.box((0, 0, z - 0.32), (0.3, 9.2, z + 0.32))
        mesh.box((4.18, 0, z - 0.42), (5.02, 0.5, z + 0.42))
        mesh.box((4.3, 0.5, z - 0.3), (4.9, 8.2, z + 0.3))
        mesh.box((4.18, 8.2, z - 0.42), (5.02, 8.6, z + 0.42))
        mesh.box((0, 9.2, z - 0.25), (12, 9.9, z + 0.25))
    mesh.box((4.25, 8.6, -18), (4.95, 9.2, 12))
    mesh.box((-0.6, 9.9, -18), (12.6, 11, 12))     # roof, end and right wall
    mesh.box((-0.6, 0, -18.6), (12.6, 11, -18))
    mesh.box((12, 0, -18), (12.6, 11, 12))
    return mesh


def add_crate(mesh, x, y, z, size, turn):
    c, s = math.cos(turn), math.sin(turn)
    part = Mesh()
    part.box((-0.47 * size, 0.03 * size, -0.47 * size), (0.47 * size, 0.97 * size, 0.47 * size))
    for side in (-1, 1):
        for other in (-1, 1):
            part.box((side * 0.5 * size - 0.05 * size, 0, other * 0.5 * size - 0.05 * size),
                     (side * 0.5 * size + 0.03 * size, size, other * 0.5 * size + 0.03 * size))
        for level in (0, 0.45, 0.9):
            part.box((-0.5 * size, level * size, side * 0.5 * size - 0.03 * size),
                     (0.5 * size, (level + 0.1) * size, side * 0.5 * size + 0.03 * size))
            part.box((side * 0.5 * size - 0.03 * size, level * size, -0.5 * size),
                     (side * 0.5 * size + 0.03 * size, (level + 0.1) * size, 0.5 * size))
    mesh.add([(x + c * p[0] + s * p[2], y + p[1], z - s * p[0] + c * p[2]) for p in part.points],
             [[i - 1 for i in face] for face in part.faces])


def make_crates():
    """Crates that stand on the floor of the hall."""
    dice, mesh = random.Random(7), Mesh()
    for x, z in ((2.2, -1.2), (2.9, -2.3), (2.3, -8.6), (6.7, -9.4), (7.9, -10.2), (6.2, -3.1)):
        size = dice.uniform(0.8, 1.1)
        add_crate(mesh, x, 0, z, size, dice.uniform(-0.5, 0.5))
        if dice.random() < 0.6:
            add_crate(mesh, x + dice.uniform(-0.1, 0.1), size, z, 0.75 * size, dice.uniform(-0.6, 0.6))
    return mesh


def make_people():
    """Three people 1.7 high, turned on a lathe, in the hall."""
    mesh = Mesh()
    for x, z, height in ((5.9, -5.6, 1.74), (6.5, -5.3, 1.62), (2.8, -11.3, 1.7)):
        part, sides = Mesh(), 20
        profile = [(0.001, 0), (0.17, 0.01), (0.16, 0.25), (0.21, 0.5), (0.17, 0.6), (0.22, 0.76), (0.19, 0.82), (0.06, 0.845),
                   (0.055, 0.865), (0.085, 0.9), (0.09, 0.94), (0.07, 0.98), (0.001, 1)]
        part.revolve([(r, h * height) for r, h in profile], sides)
        flat = [0.62 if h < 0.85 else 1 for _, h in profile]
        mesh.add([(x + p[0], p[2], z + p[1] * flat[i // sides]) for i, p in enumerate(part.points)],
                 [[i - 1 for i in face] for face in part.faces])
    return mesh


def add_facade(mesh, place, length, storeys, storey=1.0, window=0.42, bay=0.85):
    """A front with recessed windows, sills and a cornice, `length` wide. `place(along, out, up)` gives the points, with
    `out` pointing to the street."""
    def box(low, high):
        corners = [place(a, o, u) for a in (low[0], high[0]) for o in (low[1], high[1]) for u in (low[2], high[2])]
        mesh.add(corners, [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])

    top, bays = storeys * storey + 0.25, max(int(length / bay), 1)
    bay = length / bays
    box((0, -0.9, 0), (length, -0.14, top))
    for i in range(bays + 1):
        low, high = i * bay - 0.5 * (bay - window), i * bay + 0.5 * (bay - window)
        box((max(low, 0), -0.14, 0), (min(high, length), 0, top))
    for level in range(storeys + 1):
        low, high = level * storey - 0.2 * storey, level * storey + 0.3 * storey
        box((0, -0.14, max(low, 0)), (length, -0.002, min(high, top)))
        if level < storeys:
            for i in range(bays):
                middle = (i + 0.5) * bay
                box((middle - 0.6 * window, -0.02, high - 0.05), (middle + 0.6 * window, 0.05, high))
                box((middle - 0.012, -0.12, high), (middle + 0.012, -0.1, high + 0.5 * storey))
                box((middle - 0.5 * window, -0.12, high + 0.28), (middle + 0.5 * window, -0.1, high + 0.3))
    box((-0.03, -0.9, top), (length + 0.03, 0.09, top + 0.09))


def make_street():
    """Houses on both sides of a street and across its end, around a blast at (2.2, 2.2); Z is up."""
    mesh = Mesh()
    for y, length, storeys in ((-6.5, 3.1, 2), (-3.4, 3.4, 4), (0.0, 4.1, 3), (4.1, 3.6, 4)):
        add_facade(mesh, lambda a, o, u, y=y: (-0.9 + o, y + a, u), length, storeys, 0.92)
    for y, length, storeys in ((-5.2, 3.4, 3), (-1.8, 4.2, 2), (2.4, 2.9, 4), (5.3, 3.2, 3)):
        add_facade(mesh, lambda a, o, u, y=y: (5.6 - o, y + a, u), length, storeys, 0.96)
    for x, length, storeys in ((-2, 3.8, 3), (1.8, 2.6, 4), (4.4, 4.2, 3)):
        add_facade(mesh, lambda a, o, u, x=x: (x + a, 9.2 - o, u), length, storeys, 1.0)
    mesh.box((-0.9, -8, 0), (-0.15, 9, 0.05))     # pavements
    mesh.box((4.85, -8, 0), (5.6, 9, 0.05))
    for x, y, arm in ((-0.25, -3.2, 0.5), (4.95, -0.6, -0.5), (-0.25, 5, 0.5)):
        mesh.box((x - 0.02, y - 0.02, 0), (x + 0.02, y + 0.02, 2.1))
        mesh.box((min(x, x + arm), y - 0.015, 2.07), (max(x, x + arm), y + 0.015, 2.1))
    return mesh


def make_rubble():
    """Stones on the street and in the air around the blast at (2.2, 2.2); Z is up."""
    dice, mesh = random.Random(2), Mesh()

    def stone(x, y, z, size):
        points = []
        for i in range(8):
            corner = [(1 if i >> axis & 1 else -1) * size * dice.uniform(0.55, 1) for axis in range(3)]
            points.append(corner)
        for a, b in ((0, 1), (1, 2), (0, 2)):
            c, s = math.cos(angle := 2 * math.pi * dice.random()), math.sin(angle)
            for p in points:
                p[a], p[b] = c * p[a] - s * p[b], s * p[a] + c * p[b]
        mesh.add([(x + p[0], y + p[1], max(z + p[2], 0.001)) for p in points],
                 [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])

    for _ in range(300):
        angle, away = 2 * math.pi * dice.random(), 1.2 + abs(dice.gauss(0, 2.4))
        x, y = 2.2 + away * math.cos(angle), 2.2 + away * math.sin(angle)
        if -0.7 < x < 5.4:
            size = 0.011 / max(dice.random(), 0.1)
            stone(x, y, 0.4 * size, size)
    for _ in range(90):
        angle, rise, away = 2 * math.pi * dice.random(), dice.uniform(0.15, 1.3), dice.uniform(1.7, 3.4)
        stone(2.2 + away * math.cos(angle) * math.cos(rise), 2.2 + away * math.sin(angle) * math.cos(rise),
              0.5 + away * math.sin(rise), 0.012 / max(dice.random(), 0.3))
    return mesh
