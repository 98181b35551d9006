"""Slurm on the loopback interface, for a test: munged, slurmctld and slurmd in a folder of their own.

Needs Debian's munge, slurmctld, slurmd and slurm-client, no systemd, and no configuration of the
machine. Whatever is started is ended by its process id.
"""
import os
import pathlib
import secrets
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo", "scancel"]

CONFIG = """\
ClusterName=vdbeam
SlurmctldHost={node}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
CommunicationParameters=NoInAddrAny
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=5
MinJobAge=600
NodeName={node} NodeAddr=127.0.0.1 NodeHostname={host} CPUs={cpus} RealMemory=4096
PartitionName=test Nodes={node} Default=YES MaxTime=00:10:00 State=UP
"""


class CannotRun(Exception):
    """This machine cannot run Slurm; the text says why."""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class SlurmSandbox:
    """A cluster of one node. Use it in a `with` statement; `folder` must be empty."""

    def __init__(self, folder, cpus=4):
        self.folder = pathlib.Path(folder)
        self.cpus = cpus
        self.processes = []
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))
        for name in [name for name in self.environment if name.startswith(("SLURM_", "SBATCH_"))]:
            if name != "SLURM_CONF":
                del self.environment[name]
        self.environment["PATH"] += ":/usr/sbin:/sbin"

    def __enter__(self):
        missing = [p for p in PROGRAMS if not shutil.which(p, path=self.environment["PATH"])]
        if missing:
            raise CannotRun(f"not installed: {', '.join(missing)} "
                            "(apt-get install munge slurmctld slurmd slurm-client)")
        if os.geteuid() != 0:
            # slurmd starts jobs as their owner, which needs root, unless it only has one user.
            raise CannotRun("slurmd needs root")
        try:
            self._start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
        for process in reversed(self.processes):
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self._end_steps()

    def _end_steps(self):
        """Ends job steps that outlived slurmd: they name this folder's configuration."""
        mark = f"SLURM_CONF={self.folder / 'slurm.conf'}".encode()
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            if int(entry.name) == os.getpid():
                continue
            try:
                if mark in (entry / "environ").read_bytes().split(b"\0"):
                    os.kill(int(entry.name), signal.SIGKILL)
            except OSError:
                continue

    def _spawn(self, *command):
        log = open(self.folder / f"{command[0]}.out", "wb")
        self.processes.append(subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL,
                                               stdout=log, stderr=subprocess.STDOUT,
                                               start_new_session=True))

    def _start(self):
        # munged refuses folders that others may write to and sockets that others cannot reach.
        self.folder.chmod(0o755)
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o400)
        (self.folder / "slurm.conf").write_text(CONFIG.format(
            node="localhost", host=socket.gethostname().split(".")[0], user="root", cpus=self.cpus,
            folder=self.folder, controller_port=free_port(), node_port=free_port()))
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\nConstrainCores=no\n")
        self._spawn("munged", "--foreground", "--num-threads=2",
                    f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                    f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                    f"--seed-file={self.folder}/munged.seed")
        self._wait_for(lambda: (self.folder / "munge.socket").exists(), "munged", 60)
        self._spawn("slurmctld", "-D", "-c", "-i")
        self._spawn("slurmd", "-D", "-c", "-N", "localhost")
        self._wait_for(lambda: self.output("sinfo", "-h", "-o", "%T") in ("idle", "mixed"),
                       "slurmctld and slurmd", 60)

    def _wait_for(self, ready, what, seconds):
        end = time.monotonic() + seconds
        while not ready():
            dead = [p.args[0] for p in self.processes if p.poll() is not None]
            if dead or time.monotonic() > end:
                raise CannotRun(f"{', '.join(dead) or what} did not come up: {self._last_words()}")
            time.sleep(0.1)

    def _last_words(self):
        """The last lines that say what went wrong."""
        words = []
        for name in ("munged.out", "munged.log", "slurmctld.out", "slurmctld.log", "slurmd.out",
                     "slurmd.log"):
            path = self.folder / name
            lines = path.read_text(errors="replace").splitlines() if path.exists() else []
            words += [line.strip() for line in lines if "rror" in line or "fatal" in line][-2:]
        return " | ".join(words[-6:]) or "no message in its logs"

    def run(self, *command, **options):
        """Runs a Slurm command (or a script that runs some) against this cluster."""
        return subprocess.run(command, env=self.environment, capture_output=True, text=True,
                              timeout=60, check=False, **options)

    def output(self, *command):
        """Standard output of a command; empty where it fails."""
        return self.run(*command).stdout.strip()
