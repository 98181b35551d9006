#!/usr/bin/env python3
"""Templates of `vdbeam farm openjd` keep the specification's rules, and the validator knows them."""
import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from openjd_validator import Invalid, check_template, range_values

VDBEAM = os.environ["VDBEAM_BINARY"]
DATA = pathlib.Path(__file__).parents[2] / "data"


class Generated(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def farm(self, *words, scene=DATA / "smoke.toml"):
        return subprocess.run([VDBEAM, "farm", "openjd", str(scene), *words], cwd=self.folder.name,
                              capture_output=True, text=True, timeout=60, check=False)

    def template(self, *words, **options):
        result = self.farm("-o", "out.####.exr", *words, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_every_template_is_valid(self):
        for words in (["-f", "1-24"], ["-f", "7"], ["-f", "1-1000x3", "--chunk", "10"],
                      ["--frames=-5--1,3,10-1x2"], ["-f", "1,2,4,8,16", "--time-limit", "2h"],
                      ["-f", "1-3", "--set", "volume.0.extinction=80", "--passes", "3"]):
            with self.subTest(words=words):
                check_template(self.template(*words))

    def test_frames_stay_what_they_were(self):
        for text, frames in (("1-24", list(range(1, 25))), ("1-99x7", list(range(1, 100, 7))),
                             ("1,2,4,8,9,10,20", [1, 2, 4, 8, 9, 10, 20]),
                             ("-3-3", list(range(-3, 4))), ("5-1", [1, 2, 3, 4, 5]),
                             ("1-9x2,2-6x4", [1, 2, 3, 5, 6, 7, 9])):
            parameters = self.template(f"--frames={text}")["parameterDefinitions"]
            value = next(p["default"] for p in parameters if p["name"] == "Frames")
            self.assertEqual(range_values(value, text), frames)

    def test_paths_below_the_template_are_defaults(self):
        scene = pathlib.Path(self.folder.name, "shot.toml")
        scene.write_text(f'[[volume]]\nfile = "{DATA}/smoke/smoke.0024.vdb"\nextinction = 25\n'
                         '[[light]]\ntype = "environment"\nradiance = [1, 1, 1]\n')
        parameters = self.template("-f", "1-4", scene=scene)["parameterDefinitions"]
        defaults = {p["name"]: p.get("default") for p in parameters}
        self.assertEqual(defaults["SceneFolder"], ".")
        self.assertEqual(defaults["SceneName"], "shot.toml")

    def test_paths_elsewhere_must_be_said_when_submitting(self):
        result = self.farm("-o", "out.####.exr", "-f", "1-2", "--job", "job.json")
        self.assertIn(f"-p SceneFolder={DATA}", result.stderr)
        check_template(json.loads(pathlib.Path(self.folder.name, "job.json").read_text()))

    def test_what_a_template_cannot_say_is_refused(self):
        for words, text in ((["-f", "1-4", "-o", "{{a}}.####.exr"], "{{"),
                            (["-f", "1-4", "-o", "a.####.exr", "--splits", "2"], "--splits"),
                            (["-f", ",".join(str(n * n) for n in range(400)), "-o", "a.####.exr"],
                             "1024")):
            result = self.farm(*words)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(text, result.stderr)
            errors = [line for line in result.stderr.splitlines() if not line.startswith("note: ")]
            self.assertEqual(len(errors), 1)


VALID = {
    "specificationVersion": "jobtemplate-2023-09", "extensions": ["TASK_CHUNKING"], "name": "a",
    "parameterDefinitions": [{"name": "Frames", "type": "STRING", "default": "1-8"},
                             {"name": "Folder", "type": "PATH"}],
    "steps": [{
        "name": "Render",
        "hostRequirements": {"amounts": [{"name": "amount.worker.vcpu", "min": 2}]},
        "parameterSpace": {"taskParameterDefinitions": [
            {"name": "F", "type": "CHUNK[INT]", "range": "{{Param.Frames}}",
             "chunks": {"defaultTaskCount": 3, "rangeConstraint": "CONTIGUOUS"}}]},
        "script": {"actions": {"onRun": {
            "command": "run", "args": ["{{Task.Param.F}}", "{{Param.Folder}}"],
            "cancelation": {"mode": "NOTIFY_THEN_TERMINATE"}}}}}]}

STEP = ["steps", 0]
FRAME = STEP + ["parameterSpace", "taskParameterDefinitions", 0]
ACTION = STEP + ["script", "actions", "onRun"]
# A path into the template, and a value that breaks a rule there; None takes the key away.
BROKEN = [
    (["specificationVersion"], "jobtemplate-2024-01"), (["name"], ""), (["name"], "a" * 129),
    (["name"], "a\tb"), (["name"], "{{Param.Nothing}}"), (["name"], "{{Param.Folder}}"),
    (["steps"], []), (["steps"], None), (["extensions"], None), (["extensions"], []),
    (["extra"], 1), (["parameterDefinitions"], []), (["description"], ""),
    (["parameterDefinitions", 0, "name"], "2nd"), (["parameterDefinitions", 0, "name"], "Folder"),
    (["parameterDefinitions", 0, "name"], "a" * 65), (["parameterDefinitions", 0, "type"], "LIST"),
    (["parameterDefinitions", 0, "default"], "a" * 1025), (["parameterDefinitions", 0, "default"], 1),
    (["parameterDefinitions", 0, "default"], "1-8,4"), (["parameterDefinitions", 0, "minLength"], 4),
    (["parameterDefinitions", 1, "default"], "/abs"), (["parameterDefinitions", 1, "dataFlow"], "X"),
    (STEP + ["name"], "a" * 65), (STEP + ["script"], None), (STEP + ["dependencies"], []),
    (STEP + ["dependencies"], [{"dependsOn": "Render"}]),
    (STEP + ["dependencies"], [{"dependsOn": "Nobody"}]),
    (STEP + ["hostRequirements"], {}),
    (STEP + ["hostRequirements", "amounts", 0, "name"], "amount.worker.cores"),
    (STEP + ["hostRequirements", "amounts", 0, "name"], "worker.vcpu"),
    (STEP + ["hostRequirements", "amounts", 0, "min"], "2"),
    (STEP + ["hostRequirements", "amounts", 0, "min"], -1),
    (STEP + ["hostRequirements", "amounts", 0, "min"], None),
    (FRAME + ["type"], "INT"), (FRAME + ["type"], "FLOAT"), (FRAME + ["range"], "1-8x2"),
    (FRAME + ["range"], "1-10:4,10-15,8"), (FRAME + ["range"], "1-8:0"), (FRAME + ["range"], []),
    (FRAME + ["range"], list(range(1025))), (FRAME + ["range"], "{{Task.Param.F}}"),
    (FRAME + ["chunks"], None), (FRAME + ["chunks", "defaultTaskCount"], 0),
    (FRAME + ["chunks", "rangeConstraint"], "ANY"), (FRAME + ["chunks", "targetRuntimeSeconds"], -1),
    (ACTION + ["command"], ""), (ACTION + ["command"], None), (ACTION + ["timeout"], 0),
    (ACTION + ["args", 0], "{{Task.Param.G}}"), (ACTION + ["args", 0], "{{Task.Param.F"),
    (ACTION + ["args", 0], "a\nb"), (ACTION + ["args", 0], "{{1 + 2}}"),
    (ACTION + ["cancelation", "mode"], "STOP"),
    (ACTION + ["cancelation", "notifyPeriodInSeconds"], 601),
]


class Validator(unittest.TestCase):
    def test_a_valid_template_passes(self):
        check_template(VALID)

    def test_every_broken_rule_is_found(self):
        for path, value in BROKEN:
            template = copy.deepcopy(VALID)
            place = template
            for key in path[:-1]:
                place = place[key]
            if value is None:
                del place[path[-1]]
            else:
                place[path[-1]] = value
            with self.subTest(path=path, value=str(value)[:40]), self.assertRaises(Invalid):
                check_template(template)

    def test_ranges_of_the_specification(self):
        for text, values in (("1 - 5", [1, 2, 3, 4, 5]), ("1 - -1", [1]), ("-1 - 1", [-1, 0, 1]),
                             ("1-5:2", [1, 3, 5]), ("10-15:2,1-5", [1, 2, 3, 4, 5, 10, 12, 14]),
                             ("1-10:4", [1, 5, 9])):
            self.assertEqual(range_values(text, text), values)
        with self.assertRaises(Invalid):
            range_values("1-10:4,10-15", "overlap")


if __name__ == "__main__":
    sys.exit(unittest.main())
