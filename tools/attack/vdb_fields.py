"""Damage to the fields of a VDB: versions, names, types, offsets, sizes, flags, metadata, transforms and trees.

A field is changed in place or to another length; offsets behind it follow, so that all else still holds together.
"""
import struct

import damage

INTEGERS = [0, 1, 2, -1, 255, 2**16, 2**24, 2**31 - 1, -2**31, 2**32, 10**12, 2**40, 2**62, 2**63 - 1, -2**63]
DOUBLES = [0.0, -0.0, -1.0, 1e-320, 1e-300, 1e-30, 1e30, 1e300, 1.7976931348623157e308, float("inf"), float("-inf"),
           float("nan")]
FLOATS = [0.0, -1.0, 1e-45, 1e-30, 1e30, 3.4e38, float("inf"), float("-inf"), float("nan")]
TREES = [b"Tree_float_5_4_3", b"Tree_double_5_4_3", b"Tree_float_5_4_3_HalfFloat", b"Tree_vec3s_5_4_3", b"Tree_bool_5_4_3",
         b"Tree_int64_5_4_3", b"Tree_mask_5_4_3", b"Tree_string_5_4_3", b"Tree_float_3_3_3", b"Tree_float_9_9_9",
         b"Tree_ptdataidx32_5_4_3", b"", b"Tree_float_5_4_3" * 1000]
# Maps and how many numbers each holds.
MAPS = {b"UniformScaleMap": 15, b"ScaleMap": 15, b"UniformScaleTranslateMap": 18, b"ScaleTranslateMap": 18,
        b"TranslationMap": 3, b"AffineMap": 16, b"UnitaryMap": 16, b"NonlinearFrustumMap": 24}
NAMES = [b"", b"density", b"\0", b"a\nb", b"\xff\xfe", b"density\x1e1", b"a" * 100_000]
LEVEL_BYTES = 2 * 32 ** 3 // 8  # of the two masks of a node of the upper level


class Field:
    """A field holds a range of bytes in a file and the values that may replace them."""

    def __init__(self, place, size, name, values):
        self.place, self.size, self.name, self.values = place, size, name, values


def packed(form, values):
    """The values that fit the form."""
    kept = []
    for value in values:
        try:
            kept.append(struct.pack(form, value))
        except (struct.error, OverflowError):
            continue
    return kept


def text(data):
    return struct.pack("<I", len(data)) + data


class Vdb:
    """The fields of a file, from its begin on, as far as they can be made out."""

    def __init__(self, data):
        self.data, self.at, self.fields, self.offsets = data, 0, [], []
        try:
            self.header()
            for _ in range(min(self.grids, 20)):
                self.grid()
        except (struct.error, ValueError):
            pass  # a field that was changed before: those behind it cannot be found

    def number(self, form, name, values):
        size = struct.calcsize(form)
        value, = struct.unpack_from(form, self.data, self.at)
        self.fields.append(Field(self.at, size, name, packed(form, values)))
        self.at += size
        return value

    def string(self, name, values):
        size, = struct.unpack_from("<I", self.data, self.at)
        if size > len(self.data):
            raise ValueError("no text")
        self.fields.append(Field(self.at, 4, f"length of {name}", packed("<I", INTEGERS)))
        self.fields.append(Field(self.at, 4 + size, name, [text(value) for value in values]))
        self.at += 4 + size
        return self.data[self.at - size:self.at]

    def header(self):
        self.number("<q", "magic", [0, 0x56444221, -1])
        self.number("<I", "version", [0, 1, 212, 216, 220, 222, 223, 225, 2**31, 2**32 - 1])
        self.number("<I", "library", INTEGERS)
        self.number("<I", "minor library", INTEGERS)
        self.number("<B", "offsets are there", [0, 1, 255])
        self.at += 36  # the identifier
        self.metadata()
        self.grids = self.number("<i", "number of grids", INTEGERS)

    def metadata(self):
        for _ in range(min(self.number("<I", "number of entries", INTEGERS), 50)):
            name = self.string("name of an entry", [b"", b"class", b"file_voxel_count", b"file_delayed_load", b"is_local_space"])
            kind = self.string("type of an entry", [b"string", b"int64", b"vec3i", b"float", b"bool", b"mat4d", b"no type",
                                                    b"__delayedload"])
            size, = struct.unpack_from("<I", self.data, self.at)
            self.number("<I", "size of an entry", INTEGERS)
            if size > len(self.data):
                raise ValueError("no entry")
            form = {b"int64": "<q", b"vec3i": "<i", b"int32": "<i", b"float": "<f", b"double": "<d"}.get(kind)
            values = packed(form, FLOATS if form in ("<f", "<d") else INTEGERS) if form else [
                b"\0" * size, b"\xff" * size, b"level set".ljust(size)[:size], b"unknown".ljust(size)[:size]]
            for place in range(self.at, self.at + size, max(1, struct.calcsize(form) if form else size)):
                self.fields.append(Field(place, len(values[0]), f"value of {name.decode(errors='replace')}", values))
            self.at += size

    def grid(self):
        self.string("name of a grid", NAMES)
        self.string("tree of a grid", TREES)
        self.string("parent of a grid", [b"density", b"self", b"x" * 1000])
        begin = self.at
        ends = []
        for name in ("begin of a grid", "begin of its values", "end of a grid"):
            self.offsets.append(self.at)
            near = [self.at, begin, 8, len(self.data), len(self.data) - 1]
            ends.append(self.number("<q", name, [*INTEGERS, *near]))
        if not begin <= ends[0] < ends[2] <= len(self.data):
            raise ValueError("no grid")
        self.at = ends[0]
        self.number("<I", "compression", [*range(9), 255, 2**31, 2**32 - 1])
        self.metadata()
        kind = self.string("map", MAPS)
        for i in range(MAPS.get(kind, 0)):
            self.number("<d", f"number {i} of the map", DOUBLES)
        if kind in MAPS:
            self.tree()
        self.at = ends[2]

    def tree(self):
        """Fields of floats: where values are wider or narrower, other bytes are hit, which does no harm."""
        self.number("<i", "number of buffers", INTEGERS)
        self.number("<f", "background", FLOATS)
        tiles = self.number("<I", "number of root tiles", INTEGERS)
        children = self.number("<I", "number of root children", INTEGERS)
        for _ in range(min(tiles, 8)):
            self.origin()
            self.number("<f", "value of a tile", FLOATS)
            self.number("<B", "state of a tile", [0, 1, 2, 255])
        if not 0 < children < 100:
            return
        self.origin()
        for mask in ("children", "values"):
            for share in (1, 16, 64):
                size = LEVEL_BYTES // 2 // share
                self.fields.append(Field(self.at, size, f"mask of {mask}", [b"\xff" * size, b"\0" * size, b"\x55" * size]))
            self.at += LEVEL_BYTES // 2
        self.number("<B", "packing of a node", [*range(8), 127, 255])

    def origin(self):
        for axis in "xyz":
            self.number("<i", f"{axis} of an origin", [0, 1, 4095, 4096, -4096, 2**30, 2**31 - 4096, 2**31 - 1, -2**31])

    def with_value(self, field, value):
        """The file with another value of a field; offsets to what lies behind it follow."""
        longer = len(value) - field.size
        data = bytearray(self.data)
        for place in self.offsets:
            offset, = struct.unpack_from("<q", data, place)
            if longer and offset > field.place:
                struct.pack_into("<q", data, place, offset + longer)
        data[field.place:field.place + field.size] = value
        return bytes(data)


def vdb(data, rng):
    """Another value of one to three fields, or all numbers of a map, or another map with its numbers."""
    for _ in range(rng.choice([1, 1, 2, 3])):
        file = Vdb(data)
        maps = [(i, field) for i, field in enumerate(file.fields) if field.name == "map"]
        if maps and rng.random() < 0.15:
            i, field = rng.choice(maps)
            kind = rng.choice(list(MAPS))
            numbers = rng.choices(DOUBLES if rng.random() < 0.5 else [1.0, 0.5, rng.choice(DOUBLES)], k=MAPS[kind])
            old = MAPS.get(data[field.place + 4:field.place + field.size], 0)
            whole = Field(field.place, field.size + 8 * old, "map with its numbers", [])
            data = file.with_value(whole, text(kind) + struct.pack(f"<{len(numbers)}d", *numbers))
            continue
        # Names come before places, so that each kind of field is as likely as another.
        name = rng.choice(sorted({field.name for field in file.fields}))
        field = rng.choice([field for field in file.fields if field.name == name])
        data = file.with_value(field, rng.choice(field.values))
    return data
