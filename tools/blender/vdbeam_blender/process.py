"""Runs vdbeam and follows its events (docs/reference/progress.md)."""
import json
import os
import queue
import shutil
import signal
import subprocess
import threading
import time

PROTOCOL = 1
END_WITH_STDIN = "--end-with-stdin"
PATIENCE = 10.0  # seconds from the request to end until the process is killed


class ProgramMissing(Exception):
    """There is no program to run, with one line for the user."""


def find_program(path):
    """The program at `path` or, where that is empty, on the PATH. Throws ProgramMissing."""
    if path:
        found = shutil.which(os.path.expanduser(path))
        if found is None:
            raise ProgramMissing(f"there is no program {path}; correct the path in the preferences of the add-on")
        return found
    found = shutil.which("vdbeam")
    if found is None:
        raise ProgramMissing("vdbeam is not on the PATH; enter its path in the preferences of the add-on")
    return found


class Render:
    """A running render. Events are read by a thread, so that nobody waits for them."""

    def __init__(self, words, folder):
        """Starts `words`, the whole command line, in a folder. Throws ProgramMissing."""
        self.log = open(os.path.join(folder, "log.txt"), "w+b")
        try:
            # The pipe to its input ends with Blender, however Blender ends, and the program with the pipe.
            self.child = subprocess.Popen([*words, END_WITH_STDIN], cwd=folder, stdin=subprocess.PIPE,
                                          stdout=subprocess.PIPE, stderr=self.log)
        except OSError as problem:
            self.log.close()
            raise ProgramMissing(f"{words[0]} cannot be started: {problem.strerror}") from problem
        self.queue = queue.Queue()
        self.ended_at = None
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def read(self):
        """Puts events into the queue, and None at their end. Lines that are cut, or no JSON, are left out."""
        for line in self.child.stdout:
            try:
                event = json.loads(line)
            except ValueError:
                continue
            if isinstance(event, dict) and "event" in event:
                self.queue.put(event)
        self.queue.put(None)

    def next_event(self, seconds):
        """The next event; {} where none comes in this time, None when the render is over."""
        try:
            return self.queue.get(timeout=seconds)
        except queue.Empty:
            if self.ended_at is not None and time.monotonic() > self.ended_at + PATIENCE:
                self.child.kill()
            return {}

    def cancel(self):
        """Asks the render to end; next_event kills it if it does not."""
        if self.ended_at is None:
            self.ended_at = time.monotonic()
            self.child.send_signal(signal.SIGTERM)

    def kill(self):
        """Ends the render at once, without its image."""
        self.child.kill()
        self.close()

    def close(self):
        """Waits for the end; returns (exit code, last line of the log)."""
        code = self.child.wait()
        self.thread.join()
        self.child.stdin.close()
        self.child.stdout.close()
        self.log.seek(0)
        lines = [line for line in self.log.read().decode("utf-8", "replace").splitlines() if line.strip()]
        self.log.close()
        return code, lines[-1] if lines else ""


def ending(code, errors, last_line):
    """Why a render failed, as one line; empty where it did not."""
    if code == 0:
        return ""
    if errors:
        return errors[-1]
    if code < 0:
        return f"vdbeam was ended by signal {-code}{': ' + last_line if last_line else ''}"
    return last_line or f"vdbeam ended with exit code {code}"


def progress_text(event):
    """The line of an event of a pass for Blender's status: passes, error with its interval, time left."""
    parts = [f"Pass {event['pass']}" + (f"/{event['passes']}" if event.get("passes") else "")]
    if event.get("error") is not None:
        interval = ""
        if event.get("error_low") is not None and event.get("error_high") is not None:
            interval = f" ({event['error_low']:.2g} to {event['error_high']:.2g})"
        parts.append(f"error {event['error']:.2g}{interval}")
    if event.get("seconds_left"):
        parts.append(f"{event['seconds_left']:.0f} s left")
    return ", ".join(parts)
