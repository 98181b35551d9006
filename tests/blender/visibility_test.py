#!/usr/bin/env python3
"""What becomes of visibility, collections and shapes of Blender's objects in the exported tables and in the info log."""
import os
import pathlib
import sys
import tempfile
import unittest

FILE = os.path.abspath(__file__)
sys.path.insert(0, os.path.dirname(FILE))

import blender_runner  # noqa: E402

if blender_runner.inside_blender():
    import bpy
    import scenes
    from vdbeam_blender import notes, read_scene


class Tables(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def exported(self, scene):
        """The tables of a scene, and the notes."""
        found = notes.Notes()
        reader = read_scene.SceneReader(read_scene.Options(str(self.folder), bpy.path.abspath, 32, 18), found)
        return reader.read(bpy.context.evaluated_depsgraph_get(), 1.0), found.lines

    def test_what_single_rays_do_not_see_is_reported(self):
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0, -5, 5), (0, 0, 0))
        scenes.add_lamp(scene, "AREA", 3).data.cycles.is_portal = True
        dim = scenes.add_lamp(scene, "POINT", 3, shadow_soft_size=0)
        dim.visible_volume_scatter = False
        hairy = scenes.add_plane(scene, 1)
        hairy.modifiers.new("hair", "PARTICLE_SYSTEM")
        hairy.particle_systems[0].settings.type = "HAIR"
        block = scenes.add_plane(scene, 2)
        block.visible_shadow = block.visible_glossy = False
        scene.world = bpy.data.worlds.new("world")
        scene.world.cycles_visibility.camera = scene.world.cycles_visibility.diffuse = False
        scene.cycles.film_exposure = 2
        found, lines = self.exported(scene)
        scene.cycles.film_exposure = 1
        self.assertEqual([mesh["name"] for mesh in found["mesh"]], [hairy.name, block.name])
        self.assertEqual([light["visible"] for light in found["light"] if light["type"] == "environment"], [False])
        for name, text in ((dim.name, "hides it from volume rays"), (hairy.name, "hair has no counterpart"),
                           (block.name, "hides it from glossy rays, shadow rays"), ("world", "hides it from diffuse rays"),
                           (scene.name, "the exposure of Cycles' film")):
            self.assertTrue([line for line in lines if line.startswith(f"{name}: ") and text in line], (text, lines))

    def test_collections_hide_and_hold_out(self):
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0, -5, 5), (0, 0, 0))
        planes = [scenes.add_plane(scene, 1) for _ in range(3)]
        for plane, flag in zip(planes, ("holdout", "indirect_only")):
            collection = bpy.data.collections.new(flag)
            scene.collection.children.link(collection)
            scene.collection.objects.unlink(plane)
            collection.objects.link(plane)
            setattr(bpy.context.view_layer.layer_collection.children[flag], flag, True)
        meshes = {mesh["name"]: mesh for mesh in self.exported(scene)[0]["mesh"]}
        held, hidden, plain = (meshes[plane.name] for plane in planes)
        self.assertEqual(held["material"], {"type": "holdout"})
        self.assertEqual((hidden.get("visible"), hidden["material"]["type"]), (False, "diffuse"))
        self.assertEqual((plain.get("visible"), plain["material"]["type"]), (None, "diffuse"))

    def test_a_surface_that_emits_little_stays_a_surface(self):
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0, -5, 5), (0, 0, 0))
        scenes.set_world(scene, (1, 1, 1))
        for strength in (0.1, 5.0):
            plane = scenes.add_plane(scene, 1)
            plane.lightgroup = "glow"
            scenes.shader(plane.data.materials[0], "ShaderNodeBsdfPrincipled", Emission=(1, 1, 1, 1),
                          Emission_Strength=strength)
        found, lines = self.exported(scene)
        dim, bright = found["mesh"]
        self.assertEqual((dim["material"]["type"], dim.get("group")), ("standard", None))
        self.assertEqual((bright["material"]["type"], bright["group"]), ("emissive", "glow"))
        self.assertEqual(len([line for line in lines if "is left out on objects that reflect" in line]), 2, lines)

    def test_a_metaball_is_exported_once(self):
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0, -5, 5), (0, 0, 0))
        data = bpy.data.metaballs.new("ball")
        data.elements.new()
        scenes.add(scene, "ball", data)
        self.assertEqual([mesh["name"] for mesh in self.exported(scene)[0]["mesh"]], ["ball"])

    def test_a_job_reports_a_mesh_that_changes_its_shape(self):
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0, -5, 5), (0, 0, 0))
        plane = scenes.add_plane(scene, 1)
        plane.shape_key_add(name="basis")
        key = plane.shape_key_add(name="up")
        for point in key.data:
            point.co.z += 1
        for frame, value in ((1, 0.0), (2, 1.0)):
            key.value = value
            key.keyframe_insert("value", frame=frame)
        for blur, reported in ((None, False), ((-0.25, 0.25), True)):
            options = read_scene.Options(str(self.folder), bpy.path.abspath, 32, 18, blur=blur, sequence=True)
            reader = read_scene.SceneReader(options, notes.Notes())
            for frame in (1, 2):
                scene.frame_set(frame)
                reader.read(bpy.context.evaluated_depsgraph_get(), float(frame))
            self.assertEqual(any("every frame has one shape" in line for line in reader.notes.lines), reported)


if __name__ == "__main__":
    blender_runner.main(FILE)
