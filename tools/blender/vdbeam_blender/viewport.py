"""Keeps `vdbeam live` running for a viewport: writes its scene, follows its events, holds its last image.

Nothing here waits: events and images are read by a thread.
"""
import os
import threading
import time

import numpy

from . import exr, images, process, temp_folder, toml_text, view_camera

IMAGE = "view.exr"
SCENE = "scene.toml"
KEPT_SCENES = 4  # whose files of meshes stay
LONGEST_WAIT = 0.6  # seconds between two edits, where the program shows none


def pixels_of(planes, opaque):
    """Red, green, blue and alpha of an image, as float32 of (height, width, 4) with row 0 at the bottom. `opaque`:
    the world is part of the image."""
    height, width = planes["R"].shape
    pixels = numpy.ones((height, width, 4), numpy.float32)
    for index, letter in enumerate("RGB" if opaque else "RGBA"):
        pixels[..., index] = planes[letter][::-1]
    return pixels


def texts_in(value):
    """The texts in a scene's tables, among them the names of files."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, (dict, list)):
        for entry in value.values() if isinstance(value, dict) else value:
            yield from texts_in(entry)


def status_text(event):
    """The line under the viewport's name for an event of `vdbeam live`; None where there is none."""
    kind = event.get("event")
    if kind == "image":
        if event.get("passes", 0) == 0:
            return "Quick look"
        return process.progress_text({**event, "pass": event["passes"], "passes": None})
    if kind == "message" and event.get("level") == "error":
        return event["text"]
    if kind == "finished":
        return "Done"
    return None


class Preview:
    """A viewport's program, and the folder that its scene and image are in."""

    def __init__(self, program, threads=0):
        self.program = program
        self.threads = threads
        self.holder = temp_folder.TempFolder()
        self.folder = self.holder.name
        self.lock = threading.Lock()
        self.render = None
        self.scene = None  # text without the tables of the view
        self.shown_files, self.last_files = set(), []  # names in this scene, and in the last ones written
        self.view = None
        self.opaque = True
        self.written = None  # text of the scene file
        self.began_with = None  # the one that the program found when it began
        self.lines, self.turn = None, 0  # of the camera's file
        self.wrote_at = None  # when an edit was written that no image shows; None: all are shown
        self.edit_seen = False  # by the program
        self.closing = False
        self.image = None  # pixels, with their number
        self.number = 0
        self.text = ""

    def command(self):
        """The command line of the child."""
        words = [self.program, "live", SCENE, "-f", "1", "--preview", IMAGE, "--progress", "json", "-q"]
        return words + (["--threads", str(self.threads)] if self.threads else [])

    def show_scene(self, tables, opaque):
        """Takes another scene, without [image] and [camera]."""
        self.scene, self.opaque = toml_text.scene_text(tables), opaque
        self.shown_files = set(texts_in(tables))
        self.update()

    def show_view(self, view):
        """Takes another view (view_camera.tables)."""
        self.view = view
        self.update()

    def update(self):
        """Writes the scene file where it changes, and starts the program where it does not run. While the program
        has not shown the last edit, the next one waits: else a view that is dragged would never be seen. A program
        that refuses the scene with which it began may still run when the scene is mended, and ends without having
        read it: then another one is started."""
        ended = self.render is not None and self.render.child.poll() is not None
        if self.scene is None or self.view is None or self.closing or (self.is_busy() and not ended):
            return
        image, camera, lines = view_camera.tables(self.view)
        turn = self.turn if lines == self.lines else 1 - self.turn
        # The names of the camera's file take turns: whoever reads the scene finds the place that belongs to it.
        name = f"camera_{turn}.txt"
        text = toml_text.scene_text({"image": image, "camera": {"file": name, **camera}}) + "\n" + self.scene
        if text != self.written:
            self.write(text, lines, name)
            self.turn = turn
        elif not ended or self.began_with == text:
            return
        if self.render is None or self.render.child.poll() is not None:
            self.start()

    def write(self, text, lines, name):
        """Writes the scene, and the camera's file, of this name, if it changes."""
        if lines != self.lines:
            self.replace(name, lines)
        self.lines = lines
        self.replace(SCENE, text)
        self.written = text
        self.sweep()
        with self.lock:
            self.wrote_at, self.edit_seen = time.monotonic(), False

    def sweep(self):
        """Removes files of meshes and images that no scene names of those that the program may still read."""
        self.last_files = [*self.last_files[-KEPT_SCENES + 1:], self.shown_files]
        kept = set().union(*self.last_files)
        for name in os.listdir(self.folder):
            if (name.endswith(".ply") or name.startswith(images.PREFIX)) and name not in kept:
                os.remove(os.path.join(self.folder, name))

    def is_busy(self):
        """Whether the program is about to show an edit."""
        with self.lock:
            return self.wrote_at is not None and time.monotonic() < self.wrote_at + LONGEST_WAIT

    def replace(self, name, text):
        """Writes a file in one step."""
        path = os.path.join(self.folder, name)
        with open(path + ".new", "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(path + ".new", path)

    def start(self):
        """Starts the program. Throws ProgramMissing."""
        self.began_with = self.written
        self.render = process.Render(self.command(), self.folder)
        threading.Thread(target=self.follow, args=(self.render,), daemon=True).start()

    def follow(self, render):
        """Reads events and images until the program ends."""
        errors = []
        while (event := render.next_event(1.0)) is not None:
            self.note_edit(event)
            if event.get("event") == "image":
                self.read_image(event["path"])
            if event.get("event") == "message" and event.get("level") == "error":
                errors.append(event["text"])
            text = status_text(event)
            if text is not None:
                self.say(text)
        code, last_line = render.close()
        if self.closing:
            self.holder.cleanup()
        else:
            self.say(process.ending(code, errors, last_line) or "vdbeam has ended")

    def note_edit(self, event):
        """Finds out whether the last edit is shown, or refused."""
        with self.lock:
            if event.get("event") == "edit":
                self.edit_seen = True
            elif event.get("event") in ("image", "message") and (self.edit_seen or event["event"] == "message"):
                self.wrote_at = None

    def say(self, text):
        """Sets the status line."""
        with self.lock:
            self.text = text
            self.number += 1

    def read_image(self, path):
        """Takes the image that is there; one that is gone, or of another kind, is left out."""
        try:
            pixels = pixels_of(exr.read(path)[0], self.opaque)
        except (exr.ExrError, OSError, KeyError):
            return
        with self.lock:
            self.image = pixels
            self.number += 1

    def state(self):
        """(number that grows with every change, last pixels or None, status line)."""
        with self.lock:
            return self.number, self.image, self.text

    def close(self):
        """Ends the program without waiting for it; its thread removes the folder."""
        self.closing = True
        if self.render is not None and self.render.child.poll() is None:
            self.render.cancel()
        else:
            self.holder.cleanup()
