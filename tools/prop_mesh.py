"""Meshes that make_props.py fills and writes, and the noise for it."""
import math
import random


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
