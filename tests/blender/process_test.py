#!/usr/bin/env python3
"""How the Blender add-on runs a program: events, errors, cancelling, a program that is missing."""
import os
import pathlib
import sys
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools" / "blender"), str(ROOT / "tests" / "support")]

from program import InTempFolder  # noqa: E402
from vdbeam_blender import process  # noqa: E402


class Programs(InTempFolder):
    def program(self, text):
        """A program of these lines of Python."""
        path = pathlib.Path(self.file("program"))
        path.write_text(f"#!{sys.executable}\nimport json, signal, sys, time\n{text}\n", encoding="utf-8")
        path.chmod(0o755)
        return str(path)

    def follow(self, render, seconds=30):
        events, end = [], time.monotonic() + seconds
        while time.monotonic() < end:
            event = render.next_event(0.05)
            if event is None:
                return events
            if event:
                events.append(event)
        self.fail("the render does not end")

    def test_events_and_lines_that_are_none(self):
        program = self.program('print(json.dumps({"event": "start"}))\nprint(\'{"event": "pa\')\nprint("text")\n'
                               'print(json.dumps({"event": "end"}))\nsys.stderr.write("one\\nlast\\n")\nsys.exit(3)')
        render = process.Render([program], self.folder.name)
        self.assertEqual([event["event"] for event in self.follow(render)], ["start", "end"])
        code, last = render.close()
        self.assertEqual(process.ending(code, [], last), "last")
        self.assertEqual(process.ending(code, ["an error"], last), "an error")
        self.assertEqual(process.ending(-11, [], ""), "vdbeam was ended by signal 11")
        self.assertEqual(process.ending(0, [], last), "")

    def test_cancel_and_kill(self):
        for handler in ("", "signal.signal(signal.SIGTERM, signal.SIG_IGN)"):
            program = self.program(f'{handler}\nprint(json.dumps({{"event": "start"}}), flush=True)\ntime.sleep(60)')
            render = process.Render([program], self.folder.name)
            while not render.next_event(0.1):
                pass
            patience, process.PATIENCE = process.PATIENCE, 0.5
            try:
                render.cancel()
                self.follow(render)
            finally:
                process.PATIENCE = patience
            self.assertEqual(render.close()[0], -9 if handler else -15)

    def test_missing_program(self):
        with self.assertRaisesRegex(process.ProgramMissing, "there is no program /nowhere/vdbeam; correct the path"):
            process.find_program("/nowhere/vdbeam")
        path, os.environ["PATH"] = os.environ["PATH"], ""
        try:
            with self.assertRaisesRegex(process.ProgramMissing, "not on the PATH"):
                process.find_program("")
        finally:
            os.environ["PATH"] = path

    def test_progress_text(self):
        self.assertEqual(process.progress_text({"pass": 3, "passes": 8, "error": 0.0123, "error_low": 0.01,
                                                "error_high": 0.02, "seconds_left": 4.6}),
                         "Pass 3/8, error 0.012 (0.01 to 0.02), 5 s left")
        self.assertEqual(process.progress_text({"pass": 1, "passes": None, "error": None}), "Pass 1")


if __name__ == "__main__":
    unittest.main()
