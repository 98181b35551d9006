"""Kills vdbeam at calls that write, and at random moments; the same command must then give all outputs as if nothing
had been.

At calls: tests/cli/failing_disk.cpp is preloaded and kills the process before the n-th call of the C library that
concerns an output (open, fwrite, fflush, fsync, fclose, close, flock, rename, unlink, remove). At random moments: SIGTERM,
SIGINT, SIGHUP, SIGKILL, and SIGSTOP with SIGCONT.
"""
import json
import os
import pathlib
import random
import signal
import shutil
import subprocess
import tempfile
import time

import judge
import samples

LIBRARY = os.environ.get("VDBEAM_FAILING_DISK", str(samples.BUILD / "tests/libvdbeam_failing_disk.so"))
SIGNALS = [signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL, signal.SIGSTOP]
PATIENCE = 60  # seconds within which a signal must end a command, also on a busy machine


class Job:
    """A command, the folder of its inputs, and what the undisturbed command writes."""

    def __init__(self, name, words, inputs, folder):
        self.name, self.words, self.inputs, self.folder = name, words, inputs, folder / name
        self.calls = self.count_calls()
        begin = time.monotonic()
        self.restart()
        assert self.finish().returncode == 0
        self.seconds = time.monotonic() - begin
        self.expected = self.outputs()

    def restart(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(self.inputs, self.folder)

    def start(self, environment=None):
        return subprocess.Popen([judge.BINARY, *self.words], cwd=self.folder, stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True,
                                env={**os.environ, **(environment or {})})

    def preloaded(self, kill_at, log=""):
        return {"LD_PRELOAD": LIBRARY, "VDBEAM_TEST_KILL": f"{kill_at} {self.folder}", "VDBEAM_TEST_CALLS": log,
                "ASAN_OPTIONS": "verify_asan_link_order=0"}

    def count_calls(self):
        """The names of all calls that can be killed, in their order."""
        self.restart()
        log = self.folder.parent / "calls.txt"
        log.unlink(missing_ok=True)
        process = self.start(self.preloaded(0, str(log)))
        _, errors = process.communicate(timeout=PATIENCE)
        assert process.returncode == 0, errors
        return log.read_text().split()

    def finish(self):
        process = self.start()
        try:
            process.stderr_text = process.communicate(timeout=10 * PATIENCE)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            process.stderr_text = process.communicate()[1]
        return process

    def outputs(self):
        inputs = {path.name for path in self.inputs.iterdir()}
        return {path.name: content(path) for path in self.folder.iterdir() if path.name not in inputs}

    def complaint(self):
        """Runs the command again; what differs from the undisturbed run."""
        process = self.finish()
        if process.returncode != 0:
            return f"the next run ended with {process.returncode}: {process.stderr_text[-300:]!r}"
        found = self.outputs()
        for name in sorted(self.expected.keys() | found.keys()):
            if name not in found:
                return f"{name} is lost"
            if name not in self.expected:
                return f"{name} is left over"
            if found[name] != self.expected[name]:
                return f"{name} differs from the undisturbed run"
        return ""


def content(path):
    """What of an output must be the same after a kill: all but times and memory."""
    if path.suffix != ".json":
        return judge.pixels(path)
    report = json.loads(path.read_bytes())
    if "frames_asked" in report:  # a summary; a frame that was finished before the kill is skipped after it
        return report["frames_asked"], sorted(report["done"] + report["skipped"]), report["failed"]
    return report["scene_hash"], report["frame"]["number"] if isinstance(report.get("frame"), dict) else report.get("frame"), \
        report["passes"][-1]["pass"]


def jobs(folder):
    """A sequence with every output, a frame in parts, and a merge with a partial image and a preview."""
    sound = folder / "sound"
    sound.mkdir()
    subprocess.run([str(samples.BUILD / "tools/make_volumes"), "sphere", str(sound / "sphere_packed.vdb"), "--size", "10"],
                   check=True)
    samples.make_films(sound)
    for name in ("finished.exr", "flat.exr", "flat.deep.exr", "first_deep.exr"):
        (sound / name).unlink()
    every = ["--summary", "s.json", "--preview", "p.####.png", "--report", "r.####.json", "--set", "image.deep=true", "--checkpoint", "1",
             "--skip-existing", *samples.SMALL]
    render = ["render", "fog.toml", "--passes", "4", "-f", "1-2", "-o", "o.####.exr", *every]
    part = ["render", "fog.toml", "--pass-range", "0-3", "-o", "part.exr", "--checkpoint", "1", "--skip-existing",
            "--report", "part.json", *samples.SMALL]
    merge = ["merge", "-o", "m.exr", "--partial", "m_part.exr", "--preview", "m.png", "-q", "first.exr", "second.exr"]
    return [Job("render", render, sound, folder), Job("part", part, sound, folder), Job("merge", merge, sound, folder)]


def chosen_calls(job, count, rng):
    """Numbers of calls, from 1: all that are rare, and a sample of those that there are many of."""
    rare = [i + 1 for i, name in enumerate(job.calls) if name != "fwrite"]
    writes = [i + 1 for i, name in enumerate(job.calls) if name == "fwrite"]
    share = min(len(writes), max(1, count // 4))
    numbers = rng.sample(writes, share) + rng.sample(rare, min(len(rare), max(1, count - share)))
    return sorted(numbers)[:count]


def kill_at(job, number):
    """Kills before a call; what is wrong with what the next run makes of it."""
    job.restart()
    process = job.start(job.preloaded(number))
    _, errors = process.communicate(timeout=PATIENCE)
    if process.returncode not in (-signal.SIGKILL, 0):
        return f"exit code {process.returncode}: {errors[-300:]!r}"
    return job.complaint()


def kill_by(job, sent, seconds):
    """Sends a signal after some seconds."""
    job.restart()
    process = job.start()
    try:
        process.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.send_signal(sent)
        if sent == signal.SIGSTOP:
            time.sleep(0.2)
            process.send_signal(signal.SIGCONT)
    try:
        _, errors = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return f"still running {PATIENCE} s after the signal"
    wanted = (0,) if sent == signal.SIGSTOP else (0, -sent, 128 + sent)
    if process.returncode not in wanted:
        return f"exit code {process.returncode}: {errors[-300:]!r}"
    return job.complaint()


def attack(count, seed):
    """About half of the kills at calls, half at random moments. Returns the number of breaches."""
    rng, breaches, done = random.Random(seed), 0, 0
    with tempfile.TemporaryDirectory(prefix="vdbeam_kills_") as name:
        all_jobs = jobs(pathlib.Path(name))
        tries = []
        for job, share in zip(all_jobs, (0.3, 0.1, 0.1)):
            tries += [(job, f"before call {n} ({job.calls[n - 1]})", kill_at, (n,))
                      for n in chosen_calls(job, max(1, round(share * count)), rng)]
        while len(tries) < count:
            job, sent = rng.choice(all_jobs), SIGNALS[len(tries) % len(SIGNALS)]
            seconds = rng.uniform(0, job.seconds)
            tries.append((job, f"{sent.name} after {seconds:.3f} s", kill_by, (sent, seconds)))
        for job, label, kill, arguments in tries:
            done += 1
            if problem := kill(job, *arguments):
                breaches += 1
                print(f"{job.name}, {label}: {problem}", flush=True)
        print(f"{done} kills, {breaches} breaches")
    return breaches
