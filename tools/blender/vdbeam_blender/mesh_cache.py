"""What meshes became in a scene file, kept until they change: gathering triangles takes seconds where there are many."""
import os

import numpy

from . import meshes, objects, surface_shader


class Shape:
    """What is kept of a mesh."""

    def __init__(self):
        self.files = {}  # names, by the index of the material
        self.chords = {}  # mean chords, by the index and the shape of the matrix
        self.box = None  # (lower, upper) of a mesh that is a box
        self.owners = set()  # names of data and objects that it comes from

    def is_there(self, folder):
        """Whether its files are."""
        return all(os.path.exists(os.path.join(folder, file)) for file in self.files.values())


def chord_key(index, matrix):
    """What the mean chord of a material depends on: lengths and angles of the axes, not where they are and point to."""
    linear = numpy.asarray(objects.rows(matrix))[:3, :3]
    products = linear.T @ linear
    largest = float(numpy.abs(products).max()) or 1.0
    return index, f"{largest:.5g}", tuple((numpy.round(products / largest, 5) + 0.0).ravel())


def wanted_chords(shaders, matrix):
    """Keys of the chords that the colours of glass need."""
    return {chord_key(index, matrix) for index, keys in shaders.items() if surface_shader.TINT in keys}


def box_of_mesh(mesh):
    """The box that a mesh is, else None."""
    return meshes.box_of(objects.points_of(mesh)) if len(mesh.vertices) == 8 else None


def gathered(mesh, shaders, matrix, folder):
    """The shape of a mesh, with a file for each of these materials that its triangles have."""
    shape = Shape()
    shape.box = box_of_mesh(mesh)
    if len(mesh.polygons) == 0 or not shaders:
        return shape
    triangles = objects.Triangles(mesh)
    for index in shaders:
        if (triangles.materials == index).any():
            part = mesh.name if len(shaders) == 1 else f"{mesh.name}_{index}"
            shape.files[index] = meshes.write(folder, part, triangles.of_material(index))
    for key in wanted_chords(shaders, matrix):
        shape.chords[key] = meshes.mean_chord(triangles.of_one(key[0], matrix))
    return shape


class MeshCache:
    """The shapes of the meshes of a scene, by the names of their instances. Instances of the same data share one."""

    def __init__(self, folder):
        self.folder = folder
        self.by_name = {}
        self.by_data = {}  # of one traversal: Blender's addresses hold for no longer

    def begin(self, keep):
        """Another traversal of the scene begins. `keep`: shapes stay until they are forgotten."""
        self.by_data.clear()
        if not keep:
            self.by_name.clear()

    def forget(self, changed):
        """Shapes that come from these objects or data are gathered again."""
        self.by_name = {name: shape for name, shape in self.by_name.items() if not shape.owners & changed}

    def shape(self, obj, name, shaders, matrix, owners=()):
        """The shape of an object, gathered where it is not known with these materials."""
        place = (name, *shaders)
        data = (obj.data.as_pointer(), *shaders) if obj.type == "MESH" else None
        chords = wanted_chords(shaders, matrix)
        known = self.by_name.get(place) or self.by_data.get(data)
        if known is None or not known.is_there(self.folder) or not known.chords.keys() >= chords:
            mesh = obj.to_mesh()
            try:
                known = gathered(mesh, shaders, matrix, self.folder)
            finally:
                obj.to_mesh_clear()
        known.owners |= {obj.name, obj.data.name, *owners}
        self.by_name[place] = known
        if data:
            self.by_data[data] = known
        return known

