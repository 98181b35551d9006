#!/usr/bin/env python3
"""`--progress json`: every line parses, has the keys that docs/reference/progress.md lists, and comes in its
order; images are there when a line names them; errors and signals end with a line of their own."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import DATA, InTempFolder  # noqa: E402

VDBEAM = os.environ["VDBEAM_BINARY"]
PAGE = DATA.parent / "docs" / "reference" / "progress.md"
FOG = str(DATA / "fog.vdb")
SMALL = ["--resolution", "32x18", "--threads", "1", "--set", "render.photons=2000"]
ALWAYS = {"event", "t"}
# Keys of each event; those in the second set may be absent.
KEYS = {
    "start": ({"protocol", "version", "pid"}, set()),
    "batch": ({"scene", "frames", "output"}, set()),
    "stage": ({"frame", "stage"}, {"pass"}),
    "frame": ({"frame", "index", "output", "width", "height", "overscan", "estimator", "passes", "seconds",
               "target_error"}, set()),
    "pass": ({"frame", "pass", "passes", "seconds", "done", "seconds_left", "error", "error_low", "error_high",
              "photons", "peak_memory", "seconds_by_stage"}, set()),
    "file": ({"frame", "kind", "path", "pass"}, {"layers", "draft"}),
    "message": ({"level", "text"}, {"frame", "exit_code"}),
    "frame_end": ({"frame", "status", "output", "seconds", "reason"}, set()),
    "end": ({"exit_code"}, set()),
}


class Events(InTempFolder):
    def events(self, *words, code=0):
        """The events of a render, each checked by itself."""
        result = subprocess.run([VDBEAM, "render", *words, "--progress", "json"], cwd=self.folder.name,
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, code, result.stderr)
        return self.check(result.stdout, code)

    def check(self, text, code):
        self.assertTrue(text.endswith("\n"))
        events = [json.loads(line) for line in text.splitlines()]
        for event in events:
            required, optional = KEYS[event["event"]]
            keys = set(event) - ALWAYS
            self.assertLessEqual(required, keys, event)
            self.assertLessEqual(keys, required | optional, event)
        times = [event["t"] for event in events]
        self.assertEqual(times, sorted(times))
        self.assertEqual(events[0]["event"], "start")
        self.assertEqual(events[0]["protocol"], 1)
        self.assertEqual(events[-1]["event"], "end")
        self.assertEqual(events[-1]["exit_code"], code)
        return events

    @staticmethod
    def of_kind(events, kind):
        return [event for event in events if event["event"] == kind]

    def test_page_lists_every_event_and_key(self):
        page = PAGE.read_text(encoding="utf-8")
        for event, (required, optional) in KEYS.items():
            for word in {event} | required | optional:
                self.assertIn(f"`{word}`", page)
        self.assertIn("version 1 of the protocol", page)

    def test_frame_with_snapshots(self):
        events = self.events(FOG, "-o", "o.exr", "--passes", "3", "--estimator", "beam", "--snapshot", "1",
                             "--preview", "p.png", "--report", "r.json", *SMALL)
        order = [event.get("stage", event.get("kind", event["event"])) for event in events
                 if event["event"] != "message"]
        first = ["start", "batch", "read", "frame", "prepare"]
        self.assertEqual(order[:len(first)], first)
        one_pass = ["photons", "pass", "pass"]  # the second is the event after it
        shown = ["preview", "snapshot"]
        self.assertEqual(order[len(first):],
                         [*shown, "pilot", *one_pass, *shown, *one_pass, *shown, *one_pass, "write", "preview",
                          "image", "report", "frame_end", "end"])
        files = self.of_kind(events, "file")
        self.assertEqual([file["pass"] for file in files], [0, 0, 1, 1, 2, 2, 3, 3, 3])
        self.assertTrue(all(os.path.isabs(file["path"]) for file in files))
        snapshots = [file for file in files if file["kind"] == "snapshot"]
        self.assertEqual([file["draft"] for file in snapshots], [True, False, False])
        self.assertIn("rgba", snapshots[1]["layers"])
        self.assertIn("volume_direct", snapshots[1]["layers"])
        passes = self.of_kind(events, "pass")
        self.assertEqual([event["pass"] for event in passes], [1, 2, 3])
        self.assertEqual({event["passes"] for event in passes}, {3})
        self.assertIsNone(passes[0]["error"])  # of a single pass nothing is known
        self.assertLessEqual(passes[2]["error_low"], passes[2]["error_high"])
        self.assertEqual(passes[2]["done"], 1)
        self.assertGreater(passes[2]["peak_memory"], 1e6)
        self.assertEqual(self.of_kind(events, "frame_end")[0]["status"], "done")
        self.assertFalse(pathlib.Path(self.file("o.snapshot.exr")).exists())

    def test_path_has_no_photons(self):
        events = self.events(FOG, "-o", "o.exr", "--passes", "2", "--estimator", "path", *SMALL)
        stages = [event["stage"] for event in self.of_kind(events, "stage")]
        self.assertNotIn("photons", stages)
        self.assertEqual([stage for stage in stages if stage == "pass"], ["pass"] * 2)

    def test_files_are_whole_when_they_are_named(self):
        """Each snapshot is read when its line comes: an image of its passes, never a part of one."""
        child = subprocess.Popen([VDBEAM, "render", FOG, "-o", "o.exr", "--passes", "8", "--snapshot", "1", "-q",
                                  "--progress", "json", *SMALL], cwd=self.folder.name, stdout=subprocess.PIPE,
                                 text=True)
        read = 0
        for line in child.stdout:
            event = json.loads(line)
            if event["event"] != "file":
                continue
            try:
                data = pathlib.Path(event["path"]).read_bytes()
            except FileNotFoundError:  # the frame was finished meanwhile
                continue
            self.assertEqual(data[:4], b"\x76\x2f\x31\x01")
            found = re.search(rb"vdbeam:passes\x00int\x00\x04\x00\x00\x00(....)", data, re.DOTALL)
            self.assertGreaterEqual(int.from_bytes(found[1], "little"), event["pass"])
            read += 1
        child.stdout.close()
        self.assertEqual(child.wait(), 0)
        self.assertGreaterEqual(read, 1)

    def test_image_does_not_depend_on_events_and_snapshots(self):
        self.events(FOG, "-o", "a.exr", "--passes", "2", "--snapshot", "1", *SMALL)
        subprocess.run([VDBEAM, "render", FOG, "-o", "b.exr", "--passes", "2", "-q", *SMALL], cwd=self.folder.name,
                       check=True)
        compare = subprocess.run([VDBEAM, "compare", "a.exr", "b.exr", "--json"], cwd=self.folder.name,
                                 capture_output=True, text=True, check=True)
        self.assertEqual(json.loads(compare.stdout)["rmse"], 0)

    def test_snapshot_by_time_shows_the_first_pass(self):
        events = self.events(FOG, "-o", "o.exr", "--passes", "3", "--snapshot", "1h", *SMALL)
        snapshots = [file["pass"] for file in self.of_kind(events, "file") if file["kind"] == "snapshot"]
        self.assertEqual(snapshots, [0, 1])

    def test_batch_reports_each_frame(self):
        for number in (1, 3):
            os.symlink(FOG, self.file(f"fog.{number:04d}.vdb"))
        events = self.events("fog.####.vdb", "-f", "1-3", "-o", "o.####.exr", "--passes", "1", *SMALL, code=3)
        ends = self.of_kind(events, "frame_end")
        self.assertEqual([end["status"] for end in ends], ["done", "failed", "done"])
        errors = [event for event in self.of_kind(events, "message") if event["level"] == "error"]
        self.assertEqual(len(errors), 1)
        self.assertEqual(errors[0]["exit_code"], 2)
        self.assertEqual(errors[0]["frame"], 2)
        self.assertIn("fog.0002.vdb", errors[0]["text"])
        self.assertEqual(self.of_kind(events, "batch")[0]["frames"], [1, 2, 3])

    def test_bad_input_is_an_event(self):
        for words, text in ((["missing.toml"], "missing.toml"), ([FOG, "--pases", "3"], "--passes"),
                            ([FOG, "--snapshot", "0"], "--snapshot 0: must be a time like 2s"),
                            ([FOG, "--report", "-"], "--progress")):
            events = self.events(*words, code=2)
            error = self.of_kind(events, "message")[-1]
            self.assertEqual((error["level"], error["exit_code"]), ("error", 2))
            self.assertIn(text, error["text"])

    def test_cancel(self):
        child = subprocess.Popen([VDBEAM, "render", FOG, "-o", "o.exr", "--passes", "100000", "-q", "--progress",
                                  "json", *SMALL], cwd=self.folder.name, stdout=subprocess.PIPE, text=True)
        lines = []
        for line in child.stdout:
            lines.append(line)
            if json.loads(line)["event"] == "pass":
                child.send_signal(signal.SIGTERM)
                break
        rest, _ = child.communicate(timeout=60)
        events = self.check("".join(lines) + rest, 143)
        self.assertEqual(self.of_kind(events, "file")[-1]["kind"], "checkpoint")
        self.assertEqual(self.of_kind(events, "frame_end")[0]["status"], "interrupted")

    def test_reader_that_leaves_costs_nothing(self):
        child = subprocess.Popen([VDBEAM, "render", FOG, "-o", "o.exr", "--passes", "3", "-q", "--progress", "json",
                                  *SMALL], cwd=self.folder.name, stdout=subprocess.PIPE)
        child.stdout.readline()
        child.stdout.close()
        self.assertEqual(child.wait(timeout=60), 0)
        self.assertTrue(pathlib.Path(self.file("o.exr")).exists())

    def test_nothing_changes_without_it(self):
        result = subprocess.run([VDBEAM, "render", FOG, "-o", "o.exr", "--passes", "1", *SMALL],
                                cwd=self.folder.name, capture_output=True, text=True, check=True)
        self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()
