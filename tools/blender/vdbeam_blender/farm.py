"""The operator that writes a farm job: a scene file with all frames, and the job of an engine."""
import os
import subprocess

import bpy

from . import engine, export, layers, notes, process, read_scene, settings, view_transform


def job_words(program, own, scene, folder, found):
    """The command that writes the job file, and its path. `found`: gets what has no counterpart."""
    frames = f"{scene.frame_start}-{scene.frame_end}" + (f"x{scene.frame_step}" if scene.frame_step > 1 else "")
    suffix = "json" if own.engine == "openjd" else "sbatch"
    words = [program, "farm", own.engine, "scene.toml", f"--frames={frames}", "-o", "frames/image.####.exr", "--job",
             f"job.{suffix}", "--chunk", str(own.chunk), f"--also=--missing={scene.vdbeam.missing}"]
    if own.preview:
        words += [f"--also={word}" for word in ("--preview=frames/image.####.png",
                                                *view_transform.view_words(scene.view_settings, found))]
    os.makedirs(os.path.join(folder, "frames"), exist_ok=True)
    return words, os.path.join(folder, f"job.{suffix}")


class VDBEAM_OT_write_farm_job(bpy.types.Operator):
    """Write the scene's frames as a scene file with its meshes, and a job file for a render farm"""

    bl_idname = "vdbeam.write_farm_job"
    bl_label = "Write Farm Job"

    directory: bpy.props.StringProperty(name="Folder", subtype="DIR_PATH", description="Folder of the job")
    engine: bpy.props.EnumProperty(name="Engine", default="slurm",
                                   items=[("slurm", "Slurm", "An sbatch script"),
                                          ("openjd", "Open Job Description", "For example for AWS Deadline Cloud")])
    chunk: bpy.props.IntProperty(name="Frames per Task", default=1, min=1)
    preview: bpy.props.BoolProperty(name="Previews", default=False, description="Also write a PNG of each frame")

    def invoke(self, context, _event):
        """Asks for the folder."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        """Writes the job."""
        folder = bpy.path.abspath(self.directory)
        frame = context.scene.frame_current
        try:
            program = process.find_program(engine.program_path())
            os.makedirs(folder, exist_ok=True)
            found = notes.Notes()
            words, job = job_words(program, self, context.scene, folder, found)
            for line in [*self.write_scene(context, folder), *found.lines]:
                self.report({"INFO"}, f"vdbeam: {line}")
            result = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        except (process.ProgramMissing, ValueError, OSError) as problem:
            self.report({"ERROR"}, f"vdbeam: {problem}")
            return {"CANCELLED"}
        finally:
            context.scene.frame_set(frame)
        if result.returncode != 0:
            self.report({"ERROR"}, f"vdbeam: {result.stderr.strip()}")
            return {"CANCELLED"}
        self.report({"INFO"}, f"vdbeam: {job} was written; its images go to {os.path.join(folder, 'frames')}")
        return {"FINISHED"}

    @staticmethod
    def write_scene(context, folder):
        """Writes the scene file of all frames; returns what has no counterpart."""
        scene = context.scene
        render = scene.render
        width = int(render.resolution_x * render.resolution_percentage / 100)
        height = int(render.resolution_y * render.resolution_percentage / 100)
        wanted, groups = settings.wanted_passes(scene, context.view_layer)
        options = read_scene.Options(
            folder, bpy.path.abspath, width, height, blur=export.shutter_of(scene), sequence=True,
            passes=layers.passes(wanted, groups), interpolation=scene.vdbeam.interpolation,
            render=settings.render_keys(scene.vdbeam))
        first, last = scene.frame_start, scene.frame_end
        margin = 1 if options.blur else 0  # the shutter reaches beyond the frames
        times = [float(number) for number in range(first - margin, last + margin + 1)]

        def go_to(time):
            scene.frame_set(int(time))
            return context.evaluated_depsgraph_get()

        title = f"{os.path.basename(bpy.data.filepath) or 'an unsaved file'}, scene {scene.name}, by the Blender add-on"
        return export.write_scene(options, times, go_to, [title])
