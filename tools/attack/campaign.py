"""Runs mutants, judges what each left behind, and keeps what broke a rule."""
import os
import pathlib
import shlex
import shutil
import struct
import tempfile
import time
import zlib

import judge
import samples
import targets


def unmarked(case):
    """Whether the damage took the mark by which a checkpoint is known: what has no mark may be anyone's file."""
    data = case.files.get("out.checkpoint.exr")
    return data is not None and not (data.startswith(b"\x76\x2f\x31\x01") and b"vdbeam:film" in data[:65536]
                                     and b"vdbeam:sceneHash" in data[:65536])


class Campaign:
    """Mutants in a folder of their own, which holds links to the sound files and copies of the damaged ones."""

    def __init__(self, keep=None):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="attack_", dir=samples.BUILD))  # for hard links
        self.place = self.folder / "case"
        self.keep = pathlib.Path(keep) if keep else None
        self.limit = judge.MemoryLimit()
        self.breaches, self.codes, self.slowest, self.largest = [], {}, (0, ""), (0, "")
        self.sound, files = samples.kept()
        self.targets = targets.Targets(self.sound, files)
        self.links = [path for path in self.sound.iterdir() if path.suffix != ".json" and
                      path.stat().st_size <= samples.LARGEST and (path.suffix != ".vdb" or path.stem == "sphere_packed")]
        self.expected = {name: judge.pixels(self.sound / name) for name in files["film"] if name.endswith(".exr")}

    def close(self):
        self.limit.close()
        shutil.rmtree(self.folder)

    def set_up(self, files):
        shutil.rmtree(self.place, ignore_errors=True)
        self.place.mkdir()
        for path in self.links:
            if path.name not in files:
                os.link(path, self.place / path.name)
        for name, data in files.items():
            (self.place / name).write_bytes(data)

    def state(self):
        return {path.name: (status.st_ino, status.st_size, status.st_mtime_ns)
                for path in self.place.iterdir() for status in [path.stat()] if not path.name.startswith(".std")}

    def run(self, case):
        """Runs a mutant; returns what is wrong with it, or ""."""
        self.set_up(case.files)
        before = self.state()
        result = judge.run(case.words, self.place, self.limit, case.patience, case.environment)
        self.codes[result.code] = self.codes.get(result.code, 0) + 1
        self.slowest = max(self.slowest, (result.seconds, case.label))
        self.largest = max(self.largest, (result.peak, case.label))
        problem = judge.complaint(result) or self.traces(case, before, result)
        if problem:
            self.breaches.append((case, problem))
            print(f"{case.label}: {problem}\n    vdbeam {shlex.join(map(str, case.words))[:400]}", flush=True)
            self.keep_case(case)
        return problem

    def traces(self, case, before, result):
        """What is wrong with the files that a command left."""
        after = self.state()
        outputs = {name for i, name in enumerate(case.words) if i and str(case.words[i - 1]).startswith("-")}
        if lost := [name for name in before if after.get(name) != before[name] and name not in outputs
                    and not name.startswith(("out.", "deep."))]:
            return f"an input was replaced or removed: {lost}"
        if lost := [name for name in case.inputs if after.get(name) != before[name]]:
            return f"an output replaced or removed an input: {lost}, exit code {result.code}"
        for name in after:
            # The other commands write text, whatever the name, and a batch page is a folder.
            is_picture = case.words[0] in ("render", "merge") and not (self.place / name).is_dir()
            if after[name] != before.get(name) and is_picture and (wrong := judge.half_written(self.place / name)):
                return f"{name}: {wrong}, exit code {result.code}"
        if case.must_succeed and result.code == 2 and unmarked(case):
            return ""
        if case.must_succeed and result.code != 0:
            return f"exit code {result.code} because of a file that can be made anew: {result.errors[-300:]!r}"
        try:
            if case.picture and judge.pixels(self.place / "out.exr") != self.expected[case.picture]:
                return "another picture than the undisturbed one"
        except (ValueError, IndexError, struct.error, zlib.error) as problem:
            return f"out.exr is taken for finished and cannot be read: {problem}"
        return ""

    def keep_case(self, case):
        if not self.keep:
            return
        target = self.keep / case.label.replace(":", "_")
        shutil.rmtree(target, ignore_errors=True)
        target.mkdir(parents=True)
        for path in self.links:
            shutil.copy(path, target / path.name)
        for name, data in case.files.items():
            (target / name).write_bytes(data)
        (target / "command.sh").write_text(f"vdbeam {shlex.join(map(str, case.words))}\n")

    def mutants(self, kinds, count, seed, hours=None):
        """`count` mutants of these kinds in turn, from number `seed` on, or until the hours are over."""
        begin = time.monotonic()
        done = 0
        while done < count and (hours is None or time.monotonic() - begin < 3600 * hours):
            self.run(self.targets.make(kinds[done % len(kinds)], seed + done // len(kinds)))
            done += 1
            if done % 500 == 0:
                print(f"{done} mutants, {time.monotonic() - begin:.0f} s, {len(self.breaches)} breaches", flush=True)
        codes = ", ".join(f"{code}: {n}" for code, n in sorted(self.codes.items()))
        print(f"{done} mutants in {time.monotonic() - begin:.0f} s, exit codes {codes}; slowest {self.slowest[0]:.1f} s "
              f"({self.slowest[1]}), largest {self.largest[0] / 2**20:.0f} MiB ({self.largest[1]}); "
              f"{len(self.breaches)} breaches")
