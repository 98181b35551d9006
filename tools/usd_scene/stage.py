"""Reads a stage at a time into the dictionary of a scene file. The one module that imports pxr."""
from pxr import Usd, UsdGeom, UsdShade

from . import camera, geometry, lights, values, volumes
from .settings import Settings

# Prims that hold others or are read by others.
SILENT = {"", "Xform", "Scope", "Material", "Shader", "NodeGraph", "OpenVDBAsset", "Field3DAsset", "Camera",
          "GeomSubset", "RenderSettings", "RenderProduct", "RenderVar"}


class Options:
    """What a stage is read for."""

    def __init__(self, folder, camera_path="", resolution=None, shading=None):
        self.folder = folder
        self.camera_path = camera_path
        self.resolution = resolution
        self.shading = shading or {}


def open_stage(path):
    """Opens a file. Throws ValueError."""
    try:
        return Usd.Stage.Open(path)
    except Exception as problem:  # pxr throws Tf.ErrorException, which is a RuntimeError
        raise ValueError(f"{path}: cannot be opened: {str(problem).strip().splitlines()[-1]}") from problem


class StageReader:
    """Reads a stage at one time after the other."""

    def __init__(self, stage, options, notes):
        self.stage = stage
        self.options = options
        self.notes = notes
        self.z_up = str(UsdGeom.GetStageUpAxis(stage)) == "Z"
        self.matrices = {}  # of the camera, by time
        self.settings = self.find_settings()
        self.camera = self.find_camera()

    def prims(self, root=None):
        """All prims, instances included; prototypes of point instancers are read by their instancers."""
        iterator = iter(Usd.PrimRange(root or self.stage.GetPseudoRoot(), Usd.TraverseInstanceProxies()))
        for prim in iterator:
            yield prim
            if prim.GetTypeName() == "PointInstancer":
                iterator.PruneChildren()

    def find_camera(self):
        """The camera that was asked for, that of the render settings, or the first. Throws ValueError."""
        path = self.options.camera_path or self.settings.camera
        if path:
            prim = self.stage.GetPrimAtPath(path)
            if not prim or prim.GetTypeName() != "Camera":
                raise ValueError(f"{path} is not a camera of the stage")
            return prim
        found = [prim for prim in self.prims() if prim.GetTypeName() == "Camera"]
        if not found:
            raise ValueError("the stage has no camera")
        if len(found) > 1:
            self.notes.add(str(found[0].GetPath()), "is the camera; --camera names another")
        return found[0]

    def has_shutter(self):
        """Whether the camera's shutter opens."""
        return bool(camera.shutter_keys(self.camera, self.stage.GetStartTimeCode(), self.settings))

    def find_settings(self):
        """The first render settings."""
        found = next((prim for prim in self.prims() if prim.GetTypeName() == "RenderSettings"), None)
        return Settings(found, self.options.resolution)

    def read(self, time):
        """The scene at a time, as {table: keys or list of keys}."""
        cache = UsdGeom.XformCache(time)
        self.matrices[time] = values.rows(cache.GetLocalToWorldTransform(self.camera))
        lens = camera.camera_keys(self.camera, time, self.settings, self.notes)
        tables = {"image": {**self.settings.image_keys(), "fps": self.stage.GetFramesPerSecond()},
                  "camera": {"file": "camera.txt", "up": [0.0, 0.0, 1.0] if self.z_up else [0.0, 1.0, 0.0], **lens,
                             **camera.shutter_keys(self.camera, time, self.settings)},
                  "volume": [], "mesh": [], "light": []}
        for prim in self.prims():
            if self.is_rendered(prim, time):
                self.add(prim, values.rows(cache.GetLocalToWorldTransform(prim)), time, tables)
        return {name: table for name, table in tables.items() if table}

    @staticmethod
    def is_rendered(prim, time):
        """Whether the prim is visible and meant for renders."""
        imageable = UsdGeom.Imageable(prim)
        return bool(imageable) and str(imageable.ComputeVisibility(time)) != "invisible" and \
            str(imageable.ComputePurpose()) in ("default", "render")

    def add(self, prim, matrix, time, tables, suffix=""):
        """Adds the tables of a prim."""
        kind = prim.GetTypeName()
        keys, table = None, "volume"
        if kind == "Volume":
            keys = volumes.volume_keys(prim, self.stage, matrix, time, self.options.shading, self.notes)
        elif kind == "Mesh":
            keys, table = self.mesh(prim, matrix, time), "mesh"
        elif kind in lights.KINDS:
            table, keys = lights.light_tables(prim, matrix, time, self.z_up, self.notes)
            keys.update(values.own_keys(prim, time))
        elif kind == "PointInstancer":
            self.add_instances(prim, matrix, time, tables, suffix)
        elif kind not in SILENT:
            self.notes.add(str(prim.GetPath()), f"a {kind} has no counterpart and is left out")
        if keys is not None:
            if suffix and "name" in keys:
                keys["name"] += suffix
            tables[table].append(keys)

    def mesh(self, prim, matrix, time):
        """Keys of a mesh, or None."""
        file = geometry.write_mesh(prim, time, self.options.folder, self.notes)
        if file is None:
            return None
        geometry.note_unknown(prim, time, self.notes)
        material = geometry.material_keys(self.surface_of(prim), self.stage, prim, time, self.notes)
        return {"name": str(prim.GetPath()), "file": file, "transform": values.transform(matrix),
                "material": material, **values.own_keys(prim, time)}

    def surface_of(self, prim):
        """The UsdPreviewSurface of the bound material, or None."""
        material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
        if not material:
            return None
        for shader in Usd.PrimRange(material.GetPrim()):
            if shader.GetTypeName() == "Shader" and str(values.value(shader, "info:id", None)) == "UsdPreviewSurface":
                return shader
        self.notes.add(str(material.GetPath()), "a material without a UsdPreviewSurface has no counterpart; the "
                                                "surface has its display colour")
        return None

    def add_instances(self, prim, matrix, time, tables, suffix):
        """Volumes and meshes of a point instancer's prototypes, one for each point."""
        instancer = UsdGeom.PointInstancer(prim)
        placed = instancer.ComputeInstanceTransformsAtTime(time, time, UsdGeom.PointInstancer.IncludeProtoXform,
                                                           UsdGeom.PointInstancer.IgnoreMask)
        shown = instancer.ComputeMaskAtTime(time)  # empty: all of them
        indices = instancer.GetProtoIndicesAttr().Get(time) or []
        prototypes = [self.stage.GetPrimAtPath(path) for path in instancer.GetPrototypesRel().GetForwardedTargets()]
        cache = UsdGeom.XformCache(time)
        for place, (index, instance) in enumerate(zip(indices, placed)):
            if shown and not shown[place]:
                continue
            root = prototypes[index]
            above = values.product(matrix, values.rows(instance))
            for part in self.prims(root):
                # The transform of an instance contains that of its prototype's root.
                inside = values.rows(cache.GetLocalToWorldTransform(part) *
                                     cache.GetLocalToWorldTransform(root).GetInverse())
                if self.is_rendered(part, time):
                    self.add(part, values.product(above, inside), time, tables, f"{suffix}.{place}")
