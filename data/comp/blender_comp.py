"""Builds a comp of vdbeam's layers in Blender's compositor: plate * shadow + beauty + catcher_light, denoised.

blender -b -P blender_comp.py -- shot.exr [plate.png [comp.png]]

Run in Blender's text editor, it takes the files named below. Layers that the image does not have are left out.
"""
import struct
import sys

import bpy

SHOT, PLATE, RESULT = "//shot.exr", "", ""


class Comp:
    """The compositor's nodes of a scene."""

    def __init__(self, scene):
        scene.use_nodes = True
        self.tree = scene.node_tree
        self.tree.nodes.clear()
        self.columns = 0

    def node(self, kind, **settings):
        """A node to the right of the last one."""
        node = self.tree.nodes.new(kind)
        node.location = (self.columns * 220, 0)
        self.columns += 1
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def link(self, source, target):
        """Connects an output with an input."""
        self.tree.links.new(source, target)

    def math(self, operation, first, second):
        """Two images, mixed pixel by pixel."""
        node = self.node("CompositorNodeMixRGB", blend_type=operation)
        node.inputs[0].default_value = 1
        self.link(first, node.inputs[1])
        self.link(second, node.inputs[2])
        return node.outputs[0]


def size_of(path):
    """Width and height of an EXR, by the display window in its header. Blender does not know those of layers."""
    with open(bpy.path.abspath(path), "rb") as file:
        head = file.read(1 << 20)
    found = head.index(b"displayWindow\0box2i\0")
    left, top, right, bottom = struct.unpack_from("<4i", head, found + len(b"displayWindow\0box2i\0") + 4)
    return right - left + 1, bottom - top + 1


def output_of(node, *names):
    """The first output with one of these names, or none."""
    for name in names:
        for socket in node.outputs:
            if socket.enabled and socket.name == name:
                return socket
    return None


def build(scene, shot, plate=""):
    """Builds the comp and returns it."""
    comp = Comp(scene)
    image = bpy.data.images.load(shot, check_existing=True)
    scene.render.resolution_x, scene.render.resolution_y = size_of(shot)
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    layers = comp.node("CompositorNodeImage", image=image)
    result = output_of(layers, "Combined", "Image")
    albedo = output_of(layers, "denoising_albedo", "Denoising Albedo")
    normal = output_of(layers, "denoising_normal", "Denoising Normal")
    if albedo and normal:
        denoise = comp.node("CompositorNodeDenoise", use_hdr=True, prefilter="NONE")
        comp.link(result, denoise.inputs["Image"])
        comp.link(albedo, denoise.inputs["Albedo"])
        comp.link(normal, denoise.inputs["Normal"])
        result = denoise.outputs[0]
    if plate:
        behind = comp.node("CompositorNodeImage", image=bpy.data.images.load(plate, check_existing=True)).outputs[0]
        shadow = output_of(layers, "shadow")
        if shadow:
            result = comp.math("ADD", comp.math("MULTIPLY", behind, shadow), result)
        else:
            over = comp.node("CompositorNodeAlphaOver", use_premultiply=False)
            comp.link(behind, over.inputs[1])
            comp.link(result, over.inputs[2])
            result = over.outputs[0]
        added = output_of(layers, "catcher_light")
        if added:
            result = comp.math("ADD", result, added)
    comp.link(result, comp.node("CompositorNodeComposite").inputs[0])
    comp.link(result, comp.node("CompositorNodeViewer").inputs[0])
    return comp


def main(words):
    """Builds the comp of the files that the command line names; renders it where a result is named."""
    shot, plate, result = (words + [SHOT, PLATE, RESULT][len(words):])[:3]
    scene = bpy.context.scene
    build(scene, shot, plate)
    if result:
        scene.render.filepath = bpy.path.abspath(result)
        bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
