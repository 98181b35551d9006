"""Densities made from nothing, as NumPy arrays over the box from -1 to 1, for the suite's scenes."""
import numpy as np


def lattice(points):
    axis = np.linspace(-1, 1, points)
    return np.meshgrid(axis, axis, axis, indexing="ij")


def smooth_noise(random, points, cells):
    """Values of a random lattice of this many cells, smoothly interpolated: mean 0, about 1 at most."""
    values = random.uniform(-1, 1, (cells + 2,) * 3)
    place = np.linspace(0, cells, points)
    for axis in range(3):
        index = np.minimum(place.astype(int), cells)
        share = place - index
        share = share * share * (3 - 2 * share)
        shape = [1, 1, 1]
        shape[axis] = -1
        lower = np.take(values, index, axis)
        values = lower + share.reshape(shape) * (np.take(values, index + 1, axis) - lower)
    return values


def billows(random, points, cells, octaves=4):
    """Noise whose absolute value makes round lumps with creases between them, from 0 to about 1."""
    total = np.zeros((points,) * 3)
    for octave in range(octaves):
        total += np.abs(smooth_noise(random, points, cells * 2 ** octave)) * 0.5 ** octave
    return total / 1.2


def from_distance(distance, softness):
    """1 inside (distance below 0), falling to 0 over `softness`."""
    return np.clip(0.5 - distance / softness, 0, 1)


def cumulus(random, points):
    x, y, z = lattice(points)
    ball = np.sqrt(x * x + (1.5 * (y + 0.1)) ** 2 + z * z) - 0.65
    return from_distance(np.maximum(ball - 0.35 * billows(random, points, 4), -0.35 - y), 0.06)


def stratus(random, points):
    x, y, z = lattice(points)
    edge = np.maximum(np.abs(x), np.abs(z)) - 0.85
    layer = np.abs(y) - 0.2 - 0.15 * smooth_noise(random, points, 6)
    return from_distance(np.maximum(layer, edge), 0.25)


def wisps(random, points):
    x, y, z = lattice(points)
    threads = np.abs(smooth_noise(random, points, 5) + 0.5 * smooth_noise(random, points, 11))
    inside = from_distance(np.sqrt(x * x + 2 * y * y + z * z) - 0.8, 0.3)
    return inside * np.clip(1 - 6 * threads, 0, 1)


def plume(random, points):
    x, y, z = lattice(points)
    height = (y + 1) / 2
    sway = 0.25 * height * np.sin(5 * height)
    distance = np.sqrt((x - sway) ** 2 + z * z) - 0.12 - 0.45 * height + 0.3 * billows(random, points, 5)
    return from_distance(np.maximum(distance, np.abs(y) - 0.9), 0.1) * (1.2 - height)


def tower(random, points):
    x, y, z = lattice(points)
    distance = np.sqrt(x * x + z * z) - np.where(y > 0.55, 0.75, 0.35) - 0.25 * billows(random, points, 6) + 0.1
    return from_distance(np.maximum(distance, np.abs(y) - 0.8), 0.03)


def shell(random, points):
    x, y, z = lattice(points)
    radius = np.sqrt(x * x + y * y + z * z)
    return from_distance(np.abs(radius - 0.65) - 0.1 - 0.1 * smooth_noise(random, points, 5), 0.05)


CLOUDS = {maker.__name__: maker for maker in (cumulus, stratus, wisps, plume, tower, shell)}
