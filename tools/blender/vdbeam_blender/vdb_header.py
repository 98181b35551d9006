"""Reads the headers of VDB files: names of grids and sizes of voxels. Blender reports them of volume objects only."""
import struct

MAGIC = 0x56444220
UNIFORM = ("UniformScaleMap", "UniformScaleTranslateMap")


class VdbError(Exception):
    """The file is not one that `read` understands, with one line that says why."""


class Reader:
    """An open file, read from front to back."""

    def __init__(self, file):
        self.file = file

    def take(self, form):
        """Numbers of a `struct` format."""
        size = struct.calcsize("<" + form)
        data = self.file.read(size)
        if len(data) != size:
            raise VdbError("the file is truncated")
        return struct.unpack("<" + form, data)

    def text(self):
        """The next text."""
        length = self.take("I")[0]
        if length > 4096:
            raise VdbError("the file is damaged")
        return bytes(self.take(f"{length}s")[0]).decode("utf-8", "replace")

    def skip_metadata(self):
        """Leaves out a table of names with values."""
        for _ in range(self.take("I")[0]):
            self.text()
            self.text()
            self.take(f"{min(self.take('I')[0], 2**24)}x")


def voxel_of(reader):
    """Edge of the cubic voxels of the grid that begins here; None for other maps."""
    reader.take("I")  # compression
    reader.skip_metadata()
    kind = reader.text()
    if kind not in UNIFORM:
        return None
    if kind == "UniformScaleTranslateMap":
        reader.take("3d")  # translation
    return abs(reader.take("3d")[0])


def read(path):
    """{name of a grid: edge of its voxels, None where they are no cubes}. Throws VdbError and OSError."""
    with open(path, "rb") as file:
        reader = Reader(file)
        if reader.take("q")[0] != MAGIC:
            raise VdbError("the file is no VDB")
        version = reader.take("III")[0]
        if version < 222 or not reader.take("B")[0]:
            raise VdbError("the file is of an old version")
        reader.take("36x")  # identity
        reader.skip_metadata()
        grids = {}
        for _ in range(reader.take("I")[0]):
            name = reader.text().split("\x1e")[0]  # a number follows where names are the same
            reader.text()  # type
            reader.text()  # parent of an instance
            start, _, end = reader.take("3q")
            file.seek(start)
            grids.setdefault(name, voxel_of(reader))
            file.seek(end)
        return grids
