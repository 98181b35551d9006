"""The render engine: F12, animations and the command line (blender -b -a) render by vdbeam."""
import os

import bpy

from . import export, exr, layers, process, read_scene, settings, temp_folder, view_engine

PACKAGE = __package__
POLL = 0.05  # seconds


def program_path():
    """The path in the preferences; empty where there is none."""
    add_on = bpy.context.preferences.addons.get(PACKAGE)
    return add_on.preferences.program if add_on is not None else ""


def border_of(scene, width, height):
    """(x0, y0, x1, y1) of the render border, counted from the top left; None without one."""
    render = scene.render
    if not render.use_border:
        return None
    x0, x1 = int(render.border_min_x * width), int(render.border_max_x * width)
    y0, y1 = int(render.border_min_y * height), int(render.border_max_y * height)
    if x1 <= x0 or y1 <= y0:
        return None
    return x0, height - y1, x1, height - y0


def command(program, scene, frame, border):
    """The command line of a frame."""
    own = scene.vdbeam
    words = [program, "render", "scene.toml", f"--frames={frame}", "-o", "image.exr", "--progress", "json", "-q",
             "--snapshot", f"{own.update_interval:.3f}s", "--missing", own.missing, "--no-resume"]
    if scene.render.threads_mode == "FIXED":
        words += ["--threads", str(scene.render.threads)]
    if border:
        words.append("--region=" + ",".join(str(number) for number in border))
    return words


class VdbeamRenderEngine(view_engine.Viewport, bpy.types.RenderEngine):
    """Renders a scene's volumes, lights and meshes by vdbeam."""

    bl_idname = "VDBEAM"
    bl_label = "vdbeam"
    bl_use_preview = False
    bl_use_postprocess = True
    bl_use_shading_nodes_custom = False
    bl_use_eevee_viewport = True

    def update_render_passes(self, scene=None, renderlayer=None):
        """Declares the passes for the compositor."""
        wanted, groups = settings.wanted_passes(scene, renderlayer)
        for one in layers.passes(wanted, groups):
            self.register_pass(scene, renderlayer, one.name, len(one.letters), one.letters, one.kind)

    def render(self, depsgraph):
        """Renders the frame at hand."""
        # A result without pixels crashes Blender 3.4 when it is saved, so there are some, whatever happens. Those of the
        # other view layers stay as they are.
        self.end_result(self.begin_result(0, 0, *self.size_of(depsgraph.scene), layer=depsgraph.view_layer.name))
        try:
            program = process.find_program(program_path())
            with temp_folder.TempFolder() as folder:
                self.render_in(folder, program, depsgraph)
        except (process.ProgramMissing, ValueError) as problem:
            self.fail(str(problem))

    def cancelled(self):
        """Whether the user ended the render."""
        return self.test_break()

    def fail(self, text):
        """Reports an error: in the image editor, and in the log that a script or blender -b sees."""
        self.error_set(f"vdbeam: {text}")
        self.report({"ERROR"}, f"vdbeam: {text}")

    def size_of(self, scene):
        """Width and height of the result: of the image or of the render border."""
        border = border_of(scene, self.resolution_x, self.resolution_y)
        return (border[2] - border[0], border[3] - border[1]) if border else (self.resolution_x, self.resolution_y)

    def render_in(self, folder, program, depsgraph):
        """Exports the scene into a folder and renders it there."""
        scene = depsgraph.scene
        frame = scene.frame_current
        wanted, groups = settings.wanted_passes(scene, depsgraph.view_layer)
        chosen = layers.passes(wanted, groups)
        self.update_stats("", "Exporting the scene")
        for line in self.write_scene(folder, depsgraph, frame, chosen):
            self.report({"INFO"}, f"vdbeam: {line}")
        border = border_of(scene, self.resolution_x, self.resolution_y)
        target = Target(self, scene, depsgraph.view_layer.name, chosen, folder)
        render = process.Render(command(program, scene, frame, border), folder)
        try:
            errors = self.follow(render, target)
        except BaseException:  # Blender may remove the engine meanwhile; the program ends with it
            render.kill()
            raise
        code, last_line = render.close()
        text = process.ending(code, errors, last_line)
        if text and not self.cancelled():
            self.fail(text)

    def write_scene(self, folder, depsgraph, frame, chosen):
        """Writes the scene file; returns what has no counterpart."""
        scene = depsgraph.scene
        options = read_scene.Options(
            folder, bpy.path.abspath, self.resolution_x, self.resolution_y, blur=export.shutter_of(scene), passes=chosen,
            interpolation=scene.vdbeam.interpolation, render=settings.render_keys(scene.vdbeam))
        times = export.moments(frame, options.blur)

        def go_to(time):
            if len(times) > 1:
                self.frame_set(*export.split_time(time))
            return depsgraph

        try:
            return export.write_scene(options, times, go_to)
        finally:
            if len(times) > 1:
                self.frame_set(frame, subframe=0.0)

    def follow(self, render, target):
        """Passes events on until the render ends; returns the texts of its errors."""
        errors = []
        while True:
            if self.cancelled():
                render.cancel()
            event = render.next_event(POLL)
            if event is None:
                return errors
            kind = event.get("event")
            if kind == "pass":
                self.update_progress(event["done"])
                self.update_stats("", process.progress_text(event))
                megabytes = event["peak_memory"] / 2**20
                self.update_memory_stats(memory_used=megabytes, memory_peak=megabytes)
            elif kind == "stage" and event["stage"] in ("read", "prepare", "pilot", "write"):
                self.update_stats("", event["stage"].capitalize())
            elif kind == "message":
                if event["level"] == "error":
                    errors.append(event["text"])
                else:
                    self.report({"INFO"}, f"vdbeam: {event['text']}")
            elif kind == "file" and event["kind"] in ("snapshot", "image"):
                target.show(event["path"])


class Target:
    """The result of Blender that images go to."""

    def __init__(self, engine, scene, view_layer, chosen, folder):
        self.engine = engine
        self.view_layer = view_layer
        self.chosen = chosen
        self.size = engine.size_of(scene)
        self.opaque = not scene.render.film_transparent
        self.file = os.path.join(folder, "blender.exr")
        there = {"Combined"}
        for one in chosen:
            if one.name not in there:
                engine.add_pass(one.name, len(one.letters), one.letters, layer=view_layer)

    def show(self, path):
        """Shows the passes of an EXR of vdbeam. A snapshot that is gone already is left out: the next image follows."""
        try:
            planes, _ = exr.read(path)
        except FileNotFoundError:
            return
        except (exr.ExrError, OSError) as problem:
            self.engine.report({"WARNING"}, f"vdbeam: {path}: {problem}")
            return
        exr.write(self.file, layers.planes_for_blender(planes, self.chosen, self.view_layer, self.opaque))
        result = self.engine.begin_result(0, 0, *self.size, layer=self.view_layer)
        result.load_from_file(self.file)
        self.engine.end_result(result)
