"""Small mesh files of every kind that vdbeam reads, and a picture for them: what tests mutate.

Each holds the same rippled square with normals and texture coordinates.
"""
import base64
import json
import math
import struct
import zlib

POINTS = 6  # along an edge


def rippled_square():
    """Positions, normals, texture coordinates and triangles."""
    positions, normals, uvs, triangles = [], [], [], []
    for i in range(POINTS * POINTS):
        u, v = (i % POINTS) / (POINTS - 1), (i // POINTS) / (POINTS - 1)
        positions.append((2 * u - 1, 2 * v - 1, 0.2 * math.sin(4 * u)))
        slope = 0.4 * math.cos(4 * u)
        size = math.hypot(slope, 1)
        normals.append((-slope / size, 0.0, 1 / size))
        uvs.append((u, v))
        if i % POINTS and i >= POINTS:
            triangles += [(i - POINTS - 1, i - POINTS, i), (i - POINTS - 1, i, i - 1)]
    return positions, normals, uvs, triangles


def obj_file():
    positions, normals, uvs, triangles = rippled_square()
    lines = ["# a rippled square", "mtllib none.mtl", "o square", "g all", "usemtl grey"]
    lines += ["v %.6f %.6f %.6f" % p for p in positions]
    lines += ["vn %.6f %.6f %.6f" % n for n in normals] + ["vt %.6f %.6f" % uv for uv in uvs]
    for number, corners in enumerate(triangles):
        # From the end of the list in every second face.
        shift = 1 if number % 2 else -len(positions)
        lines.append("f " + " ".join("{0}/{0}/{0}".format(c + shift) for c in corners))
    return ("\n".join(lines) + "\n").encode()


def ply_file(binary):
    positions, normals, uvs, triangles = rippled_square()
    header = ["ply", "format %s 1.0" % ("binary_little_endian" if binary else "ascii"),
              "comment a rippled square", "element vertex %d" % len(positions)]
    header += ["property float " + name for name in ("x", "y", "z", "nx", "ny", "nz", "s", "t")]
    header += ["element face %d" % len(triangles), "property list uchar int vertex_indices", "end_header"]
    vertices = [p + n + uv for p, n, uv in zip(positions, normals, uvs)]
    text = ("\n".join(header) + "\n").encode()
    if binary:
        return text + b"".join([struct.pack("<8f", *v) for v in vertices] +
                               [struct.pack("<B3i", 3, *t) for t in triangles])
    lines = [" ".join("%.6f" % number for number in v) for v in vertices]
    return text + ("\n".join(lines + ["3 %d %d %d" % t for t in triangles]) + "\n").encode()


def gltf_parts(uri):
    """The JSON and the buffer of a glTF; `uri`, of the buffer, is a function of it."""
    positions, normals, uvs, triangles = rippled_square()
    arrays = [("VEC3", 5126, [struct.pack("<3f", *p) for p in positions]),
              ("VEC3", 5126, [struct.pack("<3f", *n) for n in normals]),
              ("VEC2", 5126, [struct.pack("<2f", *uv) for uv in uvs]),
              ("SCALAR", 5123, [struct.pack("<H", i) for t in triangles for i in t])]
    buffer, views, accessors = b"", [], []
    for kind, component, values in arrays:
        data = b"".join(values)
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
        accessors.append({"bufferView": len(accessors), "componentType": component, "count": len(values),
                          "type": kind})
        buffer += data
    ends = [[f(p[axis] for p in positions) for axis in range(3)] for f in (min, max)]
    accessors[0]["min"], accessors[0]["max"] = ends
    attributes = {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"children": [1], "scale": [1, 1, 1]}, {"mesh": 0, "translation": [0, 0, 0]}],
            "meshes": [{"primitives": [{"attributes": attributes, "indices": 3, "mode": 4}]}],
            "buffers": [dict(uri(buffer), byteLength=len(buffer))], "bufferViews": views, "accessors": accessors}
    return json.dumps(gltf).encode(), buffer


def gltf_file():
    prefix = "data:application/octet-stream;base64,"
    return gltf_parts(lambda buffer: {"uri": prefix + base64.b64encode(buffer).decode()})[0]


def gltf_with_buffer(name):
    """A glTF and the buffer that it expects beside it."""
    return gltf_parts(lambda _: {"uri": name})


def glb_file():
    text, buffer = gltf_parts(lambda _: {})
    text += b" " * (-len(text) % 4)
    buffer += b"\0" * (-len(buffer) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(buffer), 0x004E4942) + buffer
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def png_file(size=8):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes((40 * x + 3 * y + c) % 256 for x in range(size) for c in range(3))
                    for y in range(size))
    header = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
