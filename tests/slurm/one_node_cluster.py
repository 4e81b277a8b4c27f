"""A Slurm of one node from Debian's packages: `python tests/slurm/one_node_cluster.py COMMAND ...` runs it there.

    apt-get install slurmctld slurmd slurm-client munge

Three processes under this one, with a folder, key and ports of their own, so that a Slurm that is there already is not
disturbed. It takes root, since slurmd starts jobs as whoever asked for them; no control groups, no database.
"""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scontrol", "scancel", "sinfo")
SECONDS_TO_START = 30.0
MUNGE_FILES = ("socket", "key-file", "log-file", "pid-file", "seed-file")
CONFIGURATION = """\
ClusterName=one_node
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_interval=2,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
KillWait=2
SlurmctldPort={controller}
SlurmdPort={daemon}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={processors} RealMemory={megabytes} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


# the plugin of Slurm hides SLURM_CONF from srun
SRUN = '#!/bin/sh\nSLURM_CONF={folder}/slurm.conf exec {srun} "$@"\n'


def reason_against() -> str:
    """Return why there can be no Slurm here, in one line; empty where there can."""
    if sys.platform != "linux" or os.geteuid():
        return "a Slurm of one's own takes root on Linux"
    if missing := [name for name in PROGRAMS if shutil.which(name) is None]:
        return f"no {', '.join(missing)}: apt-get install slurmctld slurmd slurm-client munge"
    return ""


@contextmanager
def one_node_cluster(folder: Path) -> Iterator[dict[str, str]]:
    """Start a Slurm below a folder, give the variables by which its commands find it, and end it with all its jobs.

    Raises
    ------
    TimeoutError
        If it takes no jobs within half a minute; with the last lines of its logs.
    """
    for name in ("state", "spool", "bin"):
        (folder / name).mkdir(parents=True)
    (folder / "munge.key").write_bytes(os.urandom(1024))
    (folder / "munge.key").chmod(0o600)
    (folder / "bin" / "srun").write_text(SRUN.format(folder=folder, srun=shutil.which("srun")))
    (folder / "bin" / "srun").chmod(0o755)
    controller, daemon = _free_ports(2)
    facts = {"folder": folder, "controller": controller, "daemon": daemon, "processors": os.cpu_count()}
    facts["host"] = socket.gethostname().partition(".")[0]
    facts["megabytes"] = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20 * 9 // 10
    (folder / "slurm.conf").write_text(CONFIGURATION.format(**facts))
    found = {"SLURM_CONF": str(folder / "slurm.conf"), "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
    munge = [f"--{option}={folder}/munge.{option.partition('-')[0]}" for option in MUNGE_FILES]
    with ExitStack() as running:
        for command in (["munged", "--foreground", "--force", *munge], ["slurmctld", "-D"], ["slurmd", "-D"]):
            running.enter_context(_daemon(command, folder, found))
            if command[0] == "munged":
                _wait_until((folder / "munge.socket").exists, folder)
        _wait_until(lambda: "idle" in _said(found, "sinfo", "--noheader", "--format=%T"), folder)
        try:
            yield found
        finally:
            _said(found, "scancel", "--me")
            _wait_until(lambda: not _said(found, "squeue", "--noheader"), folder)


@contextmanager
def _daemon(command: list[str], folder: Path, variables: dict[str, str]) -> Iterator[None]:
    with (folder / f"{command[0]}.out").open("w") as out:
        process = subprocess.Popen(command, stdout=out, stderr=out, env={**os.environ, **variables})
        try:
            yield
        finally:
            process.terminate()
            try:
                process.wait(SECONDS_TO_START)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _free_ports(count: int) -> list[int]:
    with ExitStack() as sockets:
        bound = [sockets.enter_context(socket.create_server(("127.0.0.1", 0))) for _ in range(count)]
        return [one.getsockname()[1] for one in bound]


def _said(variables: dict[str, str], *command: str) -> str:
    return subprocess.run(command, env={**os.environ, **variables}, capture_output=True, text=True).stdout


def _wait_until(reached: Callable[[], bool], folder: Path) -> None:
    until = time.monotonic() + SECONDS_TO_START
    while not reached():
        if time.monotonic() > until:
            last = [line for file in sorted(folder.glob("*.out")) for line in file.read_text().splitlines()[-3:]]
            raise TimeoutError(f"Slurm is not as expected after {SECONDS_TO_START:g} s: {'; '.join(last)}")
        time.sleep(0.1)


if __name__ == "__main__":
    if why := reason_against():
        sys.exit(why)
    with tempfile.TemporaryDirectory() as place, one_node_cluster(Path(place)) as variables:
        sys.exit(subprocess.run(sys.argv[1:], env={**os.environ, **variables}).returncode)
