"""Writes triangles as PLY files, which are named after their content: what is the same is written once."""
import hashlib
import os

import numpy

from . import sequence


def corner_table(positions, normals, uvs):
    """A vertex for each corner of each triangle; `uvs` may be None."""
    fields = ["x", "y", "z", "nx", "ny", "nz"] + (["s", "t"] if uvs is not None else [])
    columns = [positions, normals] + ([uvs] if uvs is not None else [])
    table = numpy.hstack(columns).astype("<f4")
    return fields, table


def distinct_rows(table):
    """(rows without repetitions, place of each row of the table among them). Rows are sorted by a hash of their bits,
    ten times faster than by their values, which decide where two hashes are the same."""
    bits = numpy.ascontiguousarray(table + numpy.float32(0)).view("<u4").astype(numpy.uint64)  # -0 is 0
    hashes = numpy.zeros(len(bits), numpy.uint64)
    for column in range(bits.shape[1]):
        hashes = (hashes ^ bits[:, column]) * numpy.uint64(0x9E3779B97F4A7C15)
        hashes ^= hashes >> numpy.uint64(29)
    _, first, places = numpy.unique(hashes, return_index=True, return_inverse=True)
    rows = table[first]
    if numpy.array_equal(rows[places], table):
        return rows, places
    return numpy.unique(table, axis=0, return_inverse=True)


def ply_bytes(positions, normals, uvs=None):
    """A binary PLY of triangles: three rows of (n, 3), (n, 3) and (n, 2) arrays for each."""
    fields, table = corner_table(positions, normals, uvs)
    # Corners that are the same become one vertex.
    unique, places = distinct_rows(table)
    triangles = places.reshape(-1, 3)
    faces = numpy.empty(len(triangles), numpy.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"] = 3
    faces["corners"] = triangles
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(unique)}",
              *(f"property float {field}" for field in fields), f"element face {len(faces)}",
              "property list uchar int vertex_indices", "end_header"]
    return ("\n".join(header) + "\n").encode() + unique.tobytes() + faces.tobytes()


def write(folder, name, data):
    """Writes the file unless it is there, and returns its name, which has the content's hash."""
    file = f"{sequence.safe_name(name)}_{hashlib.sha256(data).hexdigest()[:12]}.ply"
    path = os.path.join(folder, file)
    if not os.path.exists(path):
        with open(path, "wb") as out:
            out.write(data)
    return file


def mean_chord(triangles):
    """Mean length of the rays inside a closed surface, 4 V / A (Cauchy); 0 for an open one. `triangles`: corners, of
    (n, 3, 3)."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    normals = numpy.cross(b - a, c - a)
    area = numpy.linalg.norm(normals, axis=1).sum() / 2
    if area == 0 or numpy.linalg.norm(normals.sum(axis=0)) > 1e-3 * 2 * area:
        return 0.0
    middle = triangles.reshape(-1, 3).mean(axis=0)
    return 4 * abs((normals * (a - middle)).sum()) / 6 / area


def box_of(positions):
    """(lower, upper) where the points are the eight corners of a box with axes of its own, else None."""
    points = numpy.unique(numpy.round(numpy.asarray(positions, float), 6), axis=0)
    lower, upper = points.min(axis=0), points.max(axis=0)
    at_corner = numpy.all((points == lower) | (points == upper))
    if len(points) != 8 or not at_corner or numpy.any(upper <= lower):
        return None
    return lower.tolist(), upper.tolist()
