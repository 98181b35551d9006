"""Runs one command under limits of memory and time, and judges what it left behind."""
import json
import os
import pathlib
import re
import resource
import select
import signal
import struct
import subprocess
import time
import zlib

BINARY = os.environ.get("VDBEAM_BINARY", str(pathlib.Path(__file__).resolve().parents[2] / "build/release/vdbeam"))
MEMORY = 2 << 30
SECONDS = 20  # that a command may take; a busy machine gives it three times as long
INTERRUPTED = (129, 130, 143)


class MemoryLimit:
    """Limits this process and all that it starts: by a control group where it may make one, else by address space."""

    def __init__(self, limit=MEMORY):
        self.limit, self.group = limit, None
        for folder, name, peak in self.groups():
            try:
                group = folder / f"vdbeam_attack_{os.getpid()}"
                group.mkdir()
                (group / name).write_text(str(limit))
                (group / "cgroup.procs").write_text(str(os.getpid()))
                self.group, self.above, self.peak_file = group, folder, group / peak
                return
            except OSError:
                if group.is_dir():
                    group.rmdir()
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    @staticmethod
    def groups():
        """Folder of this process' own group in each version, and its files' names."""
        root = pathlib.Path("/sys/fs/cgroup")
        for line in pathlib.Path("/proc/self/cgroup").read_text().splitlines():
            _, controllers, group = line.split(":", 2)
            if "memory" in controllers.split(","):
                yield root / "memory" / group[1:], "memory.limit_in_bytes", "memory.max_usage_in_bytes"
            elif not controllers and (root / group[1:] / "memory.max").exists():
                yield root / group[1:], "memory.max", "memory.peak"

    def reset_peak(self):
        try:
            self.peak_file.write_text("0")
            return True
        except (OSError, AttributeError):
            return False  # an older kernel: of each process alone, then

    def peak(self):
        return int(self.peak_file.read_text())

    def close(self):
        if self.group:
            (self.above / "cgroup.procs").write_text(str(os.getpid()))
            self.group.rmdir()


class Result:
    """What a command did: its exit code (below 0: the signal that ended it), output, seconds and peak of memory. `ended`:
    a SIGTERM ended it that was sent, by which a command dies that has nothing to save."""

    def __init__(self, code, text, errors, seconds, peak, hung, ended=False):
        self.code, self.text, self.errors, self.ended = code, text, errors, ended
        self.seconds, self.peak, self.hung = seconds, peak, hung


def run(words, folder, limit=None, patience=None, environment=None):
    """Runs vdbeam in a folder. Where `patience` is given, a SIGTERM comes after this number of seconds: what was asked for may
    be long work, which must end at once then."""
    begin = time.monotonic()
    by_group = limit is not None and limit.reset_peak()
    with (folder / ".stdout").open("w+b") as output, (folder / ".stderr").open("w+b") as errors:
        process = subprocess.Popen([BINARY, *map(str, words)], cwd=folder, stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=errors, start_new_session=True,
                                   env={**os.environ, **(environment or {})})
        end = select.poll()
        descriptor = os.pidfd_open(process.pid)
        end.register(descriptor, select.POLLIN)
        ready = end.poll(1000 * (patience or SECONDS))
        sent = not ready and patience
        if sent:
            process.send_signal(signal.SIGTERM)
            ready = end.poll(1000 * SECONDS)
        waited = SECONDS
        while not ready and waited < 3 * SECONDS and used_seconds(process.pid) < SECONDS and not is_asleep(process.pid):
            waited += 1
            ready = end.poll(1000)
        if not ready:
            os.killpg(process.pid, signal.SIGKILL)
        os.close(descriptor)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = code = os.waitstatus_to_exitcode(status)
        for stream in (output, errors):
            stream.seek(0)
        peak = limit.peak() if by_group else 1024 * usage.ru_maxrss
        ended = bool(sent) and code == -signal.SIGTERM and words[0] != "render"
        return Result(code, output.read(1 << 20), errors.read(1 << 20), time.monotonic() - begin, peak, not ready, ended)


def stat_fields(process):
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return ["Z"] + ["0"] * 20


def used_seconds(process):
    """Processor time of the process and of the children that it has waited for."""
    return sum(map(int, stat_fields(process)[11:15])) / os.sysconf("SC_CLK_TCK")


def is_asleep(process):
    """Whether the process and all its children wait for something: no busy machine is to blame then."""
    children = subprocess.run(["pgrep", "-P", str(process)], capture_output=True, text=True).stdout.split()
    return all(stat_fields(one)[0] == "S" for one in [process, *children])


def complaint(result, limit=MEMORY):
    """What is wrong with how a command ended; "" where nothing is."""
    text = result.errors.decode(errors="replace")
    if result.hung:
        return f"hang: still running after {result.seconds:.0f} s"
    if result.peak >= limit - (8 << 20):
        return f"memory: {result.peak / 2**30:.2f} GiB, exit code {result.code}"
    if result.code not in (0, 2, 3, *INTERRUPTED) and not result.ended:
        return f"exit code {result.code}: {text[-300:]!r}"
    if "internal error" in text:
        return f"internal error: {text[-300:]!r}"
    if result.code in (2, 3) and not text.strip():
        return f"exit code {result.code} without a line"
    if result.code and re.search(r"[\x00-\x08\x0b-\x1f\x7f]", text):
        return f"control characters in {text[-300:]!r}"
    return ""


def half_written(path):
    """What is wrong with an output, by its format; "" where it is whole."""
    data = path.read_bytes()
    if path.name.endswith(".tmp"):
        return "a temporary file is left"
    is_exr = data.startswith(b"\x76\x2f\x31\x01")  # a partial image may have any name, and so may a report
    is_json = data.startswith(b"{") or (path.suffix == ".json" and not is_exr)
    if path.suffix == ".png" and not is_json and not data.endswith(b"IEND\xaeB\x60\x82"):
        return "a PNG without its end"
    if is_json:
        try:
            json.loads(data)
        except ValueError as problem:
            return f"not JSON: {problem}"
    if path.suffix == ".exr" and not is_json:
        try:
            return exr_complaint(data)
        except (struct.error, IndexError, ValueError, zlib.error) as problem:
            return f"an EXR that ends early: {problem}"
    return ""


class Exr:
    """The header of a single-part EXR as vdbeam writes it, and its chunks."""

    def __init__(self, data):
        self.flags = struct.unpack_from("<I", data, 4)[0]
        self.attributes, at = {}, 8
        while data[at]:
            name_end = data.index(b"\0", at)
            type_end = data.index(b"\0", name_end + 1)
            size = struct.unpack_from("<I", data, type_end + 1)[0]
            self.attributes[data[at:name_end].decode(errors="replace")] = data[type_end + 5:type_end + 5 + size]
            at = type_end + 5 + size
        self.body, self.data = at + 1, data

    def window(self):
        return struct.unpack("<4i", self.attributes["dataWindow"])

    def channels(self):
        """(name, bytes of a value) in the file's order."""
        text, at, found = self.attributes["channels"], 0, []
        while text[at]:
            end = text.index(b"\0", at)
            found.append((text[at:end].decode(errors="replace"), 2 if struct.unpack_from("<i", text, end + 1)[0] == 1 else 4))
            at = end + 17
        return found

    def is_simple(self):
        """Flat scan lines of one part, uncompressed or ZIP."""
        return self.flags >> 8 & 0x1a == 0 and self.attributes["compression"][0] in (0, 2, 3)

    def rows(self):
        """The bytes of each scan line."""
        x0, y0, x1, y1 = self.window()
        width, lines = x1 - x0 + 1, {0: 1, 2: 1, 3: 16}[self.attributes["compression"][0]]
        size = width * sum(bytes_of for _, bytes_of in self.channels())
        count = (y1 - y0 + lines) // lines
        for offset in struct.unpack_from(f"<{count}Q", self.data, self.body):
            first, packed = struct.unpack_from("<ii", self.data, offset)
            piece = self.data[offset + 8:offset + 8 + packed]
            here = min(lines, y1 - first + 1)
            if len(piece) < packed:
                raise ValueError("a chunk is cut off")
            if packed < here * size and self.attributes["compression"][0] != 0:
                piece = unpack(zlib.decompress(piece))
            for line in range(here):
                yield piece[line * size:(line + 1) * size]


def unpack(data):
    """Undoes EXR's predictor and interleaving."""
    values, last = bytearray(len(data)), 128
    for i, byte in enumerate(data):
        last = byte if i == 0 else (last + byte - 128) & 255
        values[i] = last
    half = (len(data) + 1) // 2
    result = bytearray(len(data))
    result[0::2], result[1::2] = values[:half], values[half:]
    return bytes(result)


def exr_complaint(data):
    """Whether an EXR ends early, or holds colours that are no finite numbers."""
    exr = Exr(data)
    if not exr.is_simple():
        return ""
    width = exr.window()[2] - exr.window()[0] + 1
    for row in exr.rows():
        at = 0
        for name, size in exr.channels():
            values = struct.unpack_from(f"<{width}{'e' if size == 2 else 'f'}", row, at)
            at += width * size
            if name in "RGBA" and not all(-1e39 < value < 1e39 for value in values):
                return f"pixels of channel {name} are not finite"
    return ""


def pixels(path):
    """All that an image shows: the pixels of a flat EXR, the chunks of another one, else the file."""
    data = path.read_bytes()
    if path.suffix != ".exr":
        return data
    exr = Exr(data)
    if exr.is_simple():
        return b"".join(exr.rows())
    offset = struct.unpack_from("<Q", data, exr.body)[0]
    return data[offset:]
