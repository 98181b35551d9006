"""Reads an evaluated scene into the dictionary of a scene file."""
import os

import numpy

from . import camera, glow, images, layers, mesh_cache, objects, simulation, surface_shader, visibility, world


class Options:
    """What a scene is read for. `abspath` makes Blender's paths absolute, `folder` gets the files of meshes."""

    def __init__(self, folder, abspath, width, height, **more):
        self.folder = folder
        self.abspath = abspath
        self.width = width
        self.height = height
        self.blur = None  # (open, close) in frames, or None
        self.sequence = False  # frames of a job: meshes that change become sequences
        self.interpolation = "linear"
        self.passes = [layers.COMBINED]
        self.render = {}  # keys of [render]
        for name, value in more.items():
            if not hasattr(self, name):
                raise AttributeError(name)
            setattr(self, name, value)


class SceneReader:
    """Reads a scene at one time after the other, for animated keys."""

    def __init__(self, options, notes):
        self.options = options
        self.notes = notes
        self.meshes = mesh_cache.MeshCache(options.folder)
        self.images = images.ImageFiles(options.folder, options.abspath)
        self.emissive = {}  # choices of glow.py
        self.first_points = {}  # of deforming meshes, at the first time
        self.frame, self.view_layer = 1.0, None
        self.place = None  # of the world's volume
        self.matrices = {}  # of the camera, by time

    def read(self, depsgraph, frame):
        """The scene at a time, as {table: keys or list of keys}. Throws ValueError without a camera."""
        scene = depsgraph.scene
        if scene.camera is None:
            raise ValueError("the scene has no camera")
        layers.note_unmatched(depsgraph.view_layer, self.notes)
        return {"image": self.image(scene), "camera": self.camera(scene, depsgraph, frame),
                **self.contents(depsgraph, frame)}

    def contents(self, depsgraph, frame):
        """The tables without [image] and [camera]."""
        scene = depsgraph.scene
        self.frame, self.view_layer = frame, depsgraph.view_layer
        self.meshes.begin(keep=not self.options.sequence)  # a scene at another moment has the shapes of the first
        tables = {"volume": [], "mesh": [], "light": []}
        for instance in depsgraph.object_instances:
            if instance.show_self:
                self.add(instance, scene, tables)
        fog = world.world_volume(scene.world, self.middle(scene), self.notes)
        if fog is not None:
            tables["volume"].append(fog)
        lights = world.world_lights(scene.world, self.notes, self.images.path)
        visibility.show_world(scene.world, lights, self.notes)
        visibility.note_scene(scene, self.notes)
        group = getattr(scene.world, "lightgroup", "")
        for light in lights:
            if group:
                light["group"] = group
            if scene.render.film_transparent:
                light["visible"] = False
        tables["light"] += lights
        glow.choose(tables, self.emissive, self.notes)
        tables["layer"] = layers.layer_tables(self.options.passes)
        tables["render"] = dict(self.options.render)
        return {name: table for name, table in tables.items() if table}

    def middle(self, scene):
        """The place about which the world's volume lies: that of the camera, the first that it has."""
        if self.place is None:
            self.place = [0.0] * 3 if scene.camera is None else [row[3] for row in objects.rows(scene.camera.matrix_world)[:3]]
        return self.place

    def image(self, scene):
        """Keys of [image]."""
        render = scene.render
        keys = {"width": self.options.width, "height": self.options.height, "fps": render.fps / render.fps_base}
        aspect = render.pixel_aspect_x / render.pixel_aspect_y
        if abs(aspect - 1) > 1e-6:
            keys["pixel_aspect"] = aspect
        if any(one.name.startswith("Crypto") for one in self.options.passes):
            keys["cryptomatte"] = True
        return keys

    def camera(self, scene, depsgraph, frame):
        """Keys of [camera]; its place goes to `matrices`."""
        evaluated = scene.camera.evaluated_get(depsgraph)
        render = scene.render
        size = {"width": self.options.width, "height": self.options.height,
                "pixel_aspect": render.pixel_aspect_x / render.pixel_aspect_y}
        self.matrices[frame] = objects.rows(evaluated.matrix_world)
        keys = camera.camera_keys(objects.camera_facts(evaluated, size, self.notes))
        if self.options.blur:
            keys["shutter_open"], keys["shutter_close"] = self.options.blur
        return {"file": "camera.txt", **keys}

    def add(self, instance, scene, tables):
        """Adds the tables of an object."""
        obj = instance.object
        name = obj.name
        parent = instance.parent if instance.is_instance else None
        if parent is not None and parent.type == "META" and parent.name == name:
            return  # Blender lists a metaball twice: as an object and as an instance of its mesh
        if parent is not None:
            place = "-".join(str(number) for number in instance.persistent_id if number != 0x7fffffff)
            name = f"{parent.name}.{name}.{place}"
        matrix = instance.matrix_world.copy()
        visibility.note_object(obj, name, self.notes)
        if obj.type == "VOLUME":
            self.add_volume(obj, name, matrix, scene, tables)
        elif obj.type in objects.SURFACES:
            owners = {parent.name} if parent is not None else set()
            self.add_mesh(obj, name, matrix, owners, tables)
        elif obj.type == "LIGHT":
            found = objects.lamp_table(obj, matrix, obj.data, self.notes)
            if found is not None:
                tables[found[0]].append(found[1])
        elif obj.type in ("POINTCLOUD", "CURVES", "GPENCIL", "GREASEPENCIL"):
            self.notes.add(name, "objects of this kind have no counterpart and are left out")

    def add_volume(self, obj, name, matrix, scene, tables):
        """A volume object."""
        data = obj.data
        if not data.filepath:
            return self.notes.add(name, "a volume without a file has no counterpart and is left out")
        keys = objects.volume_keys(obj, data, matrix, self.notes)
        if keys is None:
            return None
        motion = objects.volume_motion(data, scene.render.fps / scene.render.fps_base) if self.options.blur else {}
        if self.options.interpolation != "linear":
            keys["interpolation"] = self.options.interpolation
        tables["volume"].append({"name": name, **objects.volume_file(data, self.frame, self.options.abspath), **keys,
                                 **motion})
        return None

    def add_smoke(self, obj, domain, name, matrix, tables):
        """The domain of a simulation, as a volume."""
        keys = simulation.volume_table(obj, domain, name, matrix, self.frame, self.options.abspath, self.notes)
        if keys is None:
            return
        if self.options.blur:
            self.notes.add(name, "the motion of simulated smoke has no counterpart; import its cache as a volume object")
        if self.options.interpolation != "linear":
            keys["interpolation"] = self.options.interpolation
        tables["volume"].append(keys)

    def add_mesh(self, obj, name, matrix, owners, tables):
        """A mesh: a table for each of its materials, a box of fog, or smoke. `owners`: what makes it an instance."""
        domain = simulation.domain_of(obj)
        if domain is not None:
            return self.add_smoke(obj, domain, name, matrix, tables)
        shaders = {}
        for index, material in enumerate(objects.materials_of(obj) or [None]):
            keys = objects.material_keys(obj, material, self.notes, self.images.path)
            if keys is not None:
                shaders[index] = keys
        if visibility.is_holdout(obj, self.view_layer):
            shaders = {index: {"type": "holdout"} for index in shaders}
        medium, _ = objects.volume_shader_of(obj)
        if not shaders and medium is None:
            return None
        shape = self.meshes.shape(obj, name, shaders, matrix, owners)
        if medium is not None and (box := objects.mesh_volume(obj, shape.box, matrix, medium, self.notes)):
            tables["volume"].append({"name": name, **box})
        self.note_deformation(obj, name)
        for index, file in shape.files.items():
            if surface_shader.TINT in shaders[index]:
                chord = shape.chords[mesh_cache.chord_key(index, matrix)]
                shaders[index] = surface_shader.tinted_inside(shaders[index], chord, self.notes, name)
            keys = {"name": name if len(shape.files) == 1 else f"{name}.{index}", "file": file,
                    "transform": objects.transform(matrix), "material": shaders[index]}
            if not visibility.is_seen(obj, self.view_layer):
                keys["visible"] = False
            emits = shaders[index]["type"] == "emissive" or glow.GLOW in shaders[index]
            if emits and getattr(obj, "lightgroup", ""):
                keys["group"] = obj.lightgroup
            tables["mesh"].append(keys)
        return None

    def note_deformation(self, obj, name):
        """A mesh that modifiers or shape keys change while the shutter is open is that of the first moment."""
        changes = len(obj.modifiers) or getattr(obj.data, "shape_keys", None)
        if not self.options.blur or not changes:
            return
        points = objects.points_of(obj.to_mesh())
        obj.to_mesh_clear()
        first = self.first_points.setdefault(name, points)
        if first.shape != points.shape or not numpy.allclose(first, points, atol=1e-6):
            kept = "every frame has one shape" if self.options.sequence else "it keeps that of the first moment"
            self.notes.add(name, f"its shape changes while the shutter is open, which has no counterpart; {kept}")


def write_camera(folder, matrices):
    """Writes the file of the camera's places."""
    with open(os.path.join(folder, "camera.txt"), "w", encoding="ascii") as file:
        file.write("# frame, then the matrix from the camera to the world, by rows\n")
        file.write(camera.matrix_lines(matrices))
