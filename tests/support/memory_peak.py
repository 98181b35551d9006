"""The greatest memory of a program and its reader processes at one time, as a control group counts it."""
import os
import subprocess
import tempfile
import time


def fields(path, *names):
    """Sum of the fields of a file of /proc, in bytes; 0 where the process is gone."""
    total = 0
    try:
        with open(path, encoding="ascii") as file:
            for line in file:
                name, _, value = line.partition(":")
                if name in names:
                    total += 1024 * int(value.split()[0])
    except OSError:
        pass
    return total


def children(process):
    found = []
    try:
        for task in os.listdir(f"/proc/{process}/task"):
            with open(f"/proc/{process}/task/{task}/children", encoding="ascii") as file:
                found += [int(child) for child in file.read().split()]
    except OSError:
        pass
    return found


def memory_files(process):
    """Bytes of the files in memory that a process has open."""
    sizes = {}
    try:
        for number in os.listdir(f"/proc/{process}/fd"):
            path = f"/proc/{process}/fd/{number}"
            if os.readlink(path).startswith("/memfd:"):
                state = os.stat(path)
                sizes[state.st_ino] = 512 * state.st_blocks
    except OSError:
        pass
    return sum(sizes.values())


def memory_now(process):
    """What a process has resident, what its children have for themselves, and files in memory that no one has mapped."""
    total = fields(f"/proc/{process}/status", "VmRSS")
    for child in children(process):
        total += fields(f"/proc/{child}/smaps_rollup", "Private_Clean", "Private_Dirty")
        total += max(0, memory_files(process) - fields(f"/proc/{process}/status", "RssShmem"))
    return total


def run_measured(*command, env=None):
    """Exit status, output and peak [bytes] of a program: the most that samples found while children ran, and the
    kernel's own record of the program alone."""
    with tempfile.TemporaryFile() as output:
        with subprocess.Popen(command, stdout=output, stderr=output, env=env) as program:
            peak = 0
            while True:
                ended, status, usage = os.wait4(program.pid, os.WNOHANG)
                if ended:
                    break
                peak = max(peak, memory_now(program.pid))
                time.sleep(0.003)
            program.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode("utf-8", "replace")
    return program.returncode, text, max(peak, 1024 * usage.ru_maxrss)
