#!/usr/bin/env python3
"""Domains of Mantaflow inside Blender: their smoke is that of Cycles, at the place where Cycles has it. Skipped without
Blender."""
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
    import numpy
    import scenes
    from vdbeam_blender import engine, simulation, vdb_header


def bake(scene, folder, frames=6, **settings):
    """A turned and scaled domain with a source of smoke and fire, with the settings of the domain."""
    source = bpy.ops.mesh.primitive_ico_sphere_add(radius=0.4, location=(0.3, 0, -0.5)) and bpy.context.object
    flow = source.modifiers.new("fluid", "FLUID")
    flow.fluid_type = "FLOW"
    flow.flow_settings.flow_type, flow.flow_settings.flow_behavior = "BOTH", "INFLOW"
    source.hide_render = True
    domain = bpy.ops.mesh.primitive_cube_add(size=2) and bpy.context.object
    domain.scale, domain.rotation_euler = (1.2, 0.8, 1.0), (0.1, 0.2, 0.5)
    modifier = domain.modifiers.new("fluid", "FLUID")
    modifier.fluid_type = "DOMAIN"
    own = modifier.domain_settings
    own.resolution_max, own.cache_type, own.cache_data_format = 24, "ALL", "OPENVDB"
    own.cache_directory, own.cache_frame_end = str(folder), frames
    for name, value in settings.items():
        setattr(own, name, value)
    scene.frame_end = frames
    bpy.context.view_layer.objects.active = domain
    bpy.ops.fluid.bake_all()
    scene.frame_set(frames)
    return domain


class Simulations(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def shot(self, **settings):
        """Black smoke in front of a white world: nothing in its image is random."""
        scene = scenes.empty_scene()
        scenes.add_camera(scene, (0.5, -6, 1), (0, 0, 0), lens=60)
        scenes.set_world(scene, (1, 1, 1))
        self.domain = bake(scene, self.folder / "cache", **settings)
        material = bpy.data.materials.new("smoke")
        self.shader = scenes.shader(material, "ShaderNodeVolumePrincipled", "Volume", Density=3.0, Color=(0, 0, 0, 1))
        self.domain.data.materials.append(material)
        self.lines = []
        write = engine.VdbeamRenderEngine.write_scene
        self.addCleanup(setattr, engine.VdbeamRenderEngine, "write_scene", write)
        engine.VdbeamRenderEngine.write_scene = lambda *words: (self.lines.extend(write(*words)), list(self.lines))[1]
        return scene

    def compare(self, scene):
        ours = scenes.combined(scenes.render(scene, self.folder / "vdbeam.exr"))
        scenes.use_cycles(scene, 64, 1)
        theirs = scenes.combined(scenes.render(scene, self.folder / "cycles.exr"))
        scene.render.engine = "VDBEAM"
        self.assertLess(theirs.min(), 0.6)  # there is smoke
        apart = numpy.abs(scenes.blocks(ours, 10) - scenes.blocks(theirs, 10))
        self.assertLess(apart.max(), 0.015)
        self.assertLess(apart.mean(), 0.002)

    def test_smoke_stands_where_cycles_has_it(self):
        self.compare(self.shot())

    def test_domain_that_adapts(self):
        self.compare(self.shot(use_adaptive_domain=True))

    def test_noise(self):
        scene = self.shot(use_noise=True)
        self.compare(scene)
        domain = simulation.domain_of(self.domain)
        self.assertIn("density_noise", vdb_header.read(simulation.cache_file(domain, 6.0, bpy.path.abspath)[0]))

    def test_fire_has_the_temperature_of_cycles(self):
        """Cycles derives it from the flames."""
        scene = self.shot()
        scenes.set_world(scene, (0, 0, 0))
        self.shader.inputs["Density"].default_value = 0
        self.shader.inputs["Blackbody Intensity"].default_value = 1
        ours = scenes.combined(scenes.render(scene, self.folder / "vdbeam.exr"))
        scenes.use_cycles(scene, 64, 1)
        theirs = scenes.combined(scenes.render(scene, self.folder / "cycles.exr"))
        scene.render.engine = "VDBEAM"
        self.assertGreater(theirs.max(), 0.1)
        self.assertLess(numpy.abs(ours.max((0, 1)) / theirs.max((0, 1)) - 1).max(), 0.08)  # at the core
        # Ours is interpolated after its emission was computed, which makes edges of a voxel's width brighter.
        self.assertLess(numpy.abs(ours.mean((0, 1)) / theirs.mean((0, 1)) - 1.1).max(), 0.15)

    def test_what_is_not_baked_is_reported(self):
        scene = self.shot()
        scene.frame_set(5)
        os.remove(self.folder / "cache" / "data" / "fluid_data_0005.vdb")
        self.assertLess(scenes.combined(scenes.render(scene, self.folder / "a.exr")).min(), 0.6)  # of the frame before
        self.assertIn("its cache lacks frames", "".join(self.lines))
        simulation.domain_of(self.domain).cache_directory = str(self.folder / "none")
        scene.frame_set(4)
        scenes.render(scene, self.folder / "a.exr")
        self.assertIn("bake the domain with the cache format OpenVDB", "".join(self.lines))


if __name__ == "__main__":
    blender_runner.main(FILE)
