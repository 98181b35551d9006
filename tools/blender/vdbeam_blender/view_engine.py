"""What the render engine does in a 3D viewport with rendered shading: it shows the image of `vdbeam live`."""
import weakref

import bpy

from . import camera, notes, objects, process, read_scene, settings, view_camera, view_draw, viewport

POLL = 0.04  # seconds between looks for another image


def lens_of(context, depsgraph, size):
    """Keys of the thin lens where the view is that of the scene's camera."""
    view, scene = context.region_data, depsgraph.scene
    if view.view_perspective != "CAMERA" or scene.camera is None or scene.camera.type != "CAMERA":
        return {}
    image = {"width": size[0], "height": size[1], "pixel_aspect": 1.0}
    return camera.focus_keys(objects.camera_facts(scene.camera.evaluated_get(depsgraph), image, notes.Notes()))


def view_of(context, depsgraph):
    """The view of view_camera.tables."""
    region, view = context.region, context.region_data
    pixel = view_camera.pixel_size(depsgraph.scene.render.preview_pixel_size)
    size = view_camera.image_size(region.width, region.height, pixel)
    return {"size": size, "window": objects.rows(view.window_matrix),
            "camera_to_world": objects.rows(view.view_matrix.inverted()), "lens": lens_of(context, depsgraph, size)}


def changed_in(depsgraph):
    """Names of the objects and data whose geometry has changed since the last update."""
    return {update.id.name for update in depsgraph.updates if update.is_updated_geometry}


class Contents:
    """The tables of a viewport's scene without [image] and [camera]. Meshes are gathered again where they change."""

    def __init__(self, folder):
        self.reader = read_scene.SceneReader(read_scene.Options(folder, bpy.path.abspath, 1, 1), notes.Notes())

    def read(self, depsgraph):
        """The scene as it is; files of meshes go into the folder."""
        scene, options = depsgraph.scene, self.reader.options
        options.interpolation, options.render = scene.vdbeam.interpolation, settings.viewport_keys(scene.vdbeam)
        self.reader.notes = notes.Notes()
        self.reader.meshes.forget(changed_in(depsgraph))
        self.reader.images.forget()
        self.reader.emissive.clear()
        return self.reader.contents(depsgraph, float(scene.frame_current))


def watch(engine, preview):
    """Redraws the viewport when there is something new, until the engine is gone."""
    seen = [0]
    holder = weakref.ref(engine)

    def look():
        owner = holder()
        if owner is None or preview.closing:
            preview.close()
            return None
        try:
            preview.update()  # an edit that has waited
            number = preview.state()[0]
            if number != seen[0]:
                seen[0] = number
                owner.tag_redraw()
        except (ReferenceError, process.ProgramMissing):  # the viewport is gone, or the program
            preview.close()
            return None
        return POLL

    bpy.app.timers.register(look, first_interval=POLL)


class Viewport:
    """The part of a bpy.types.RenderEngine that draws viewports."""

    def view_update(self, _context, depsgraph):
        """The scene has changed."""
        try:
            preview = self.preview_of(depsgraph.scene)
            preview.show_scene(self.contents.read(depsgraph), not depsgraph.scene.render.film_transparent)
        except (process.ProgramMissing, ValueError) as problem:
            self.update_stats("", f"vdbeam: {problem}")

    def view_draw(self, context, depsgraph):
        """The viewport is drawn, perhaps from elsewhere or in another size."""
        preview = getattr(self, "preview", None)
        if preview is None:
            return
        try:
            preview.show_view(view_of(context, depsgraph))
        except process.ProgramMissing as problem:
            self.update_stats("", f"vdbeam: {problem}")
        _, pixels, text = preview.state()
        self.drawing.draw(self, depsgraph.scene, pixels, context.region.width, context.region.height)
        if text:
            self.update_stats("", text)

    def preview_of(self, scene):
        """The viewport's program, not started before there is a view."""
        if getattr(self, "preview", None) is None:
            import gpu
            from gpu_extras.presets import draw_texture_2d

            from . import engine
            threads = scene.render.threads if scene.render.threads_mode == "FIXED" else 0
            self.preview = viewport.Preview(process.find_program(engine.program_path()), threads)
            self.contents = Contents(self.preview.folder)
            self.drawing = view_draw.Drawing(gpu, draw_texture_2d)
            watch(self, self.preview)
        return self.preview

    def __del__(self):
        """Blender is done with the viewport, or with a render."""
        preview = self.__dict__.get("preview") if hasattr(self, "__dict__") else None
        if preview is not None:
            preview.close()
        parent = getattr(super(), "__del__", None)  # from Blender 4.4 on, which needs the call
        if parent is not None:
            parent()
