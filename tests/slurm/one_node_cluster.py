"""A Slurm of one node on this machine, from Debian's packages: `python tests/slurm/one_node_cluster.py` holds one up.

    apt-get install slurmctld slurmd slurm-client munge

It takes root, and the place of /etc/slurm/slurm.conf, where jobs look for it, for as long as it lasts.
"""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PLACE = Path("/etc/slurm/slurm.conf")
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo")
MEMORY = 8000
START = 30.0
CONFIGURATION = """\
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=sched_interval=2,batch_sched_delay=0
ReturnToService=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory={memory} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def reason_against() -> str:
    """Why there can be no Slurm here; "" where there can."""
    if sys.platform != "linux" or os.geteuid():
        return "a Slurm of one's own takes root on Linux"
    if missing := [name for name in PROGRAMS if shutil.which(name) is None]:
        return f"no {', '.join(missing)}: apt-get install slurmctld slurmd slurm-client munge"
    if PLACE.exists() or PLACE.is_symlink():
        return f"{PLACE} is there: this machine has a Slurm already"
    return ""


@contextmanager
def one_node_cluster() -> Iterator[Path]:
    """Start a Slurm, give its folder, and end it with all its jobs."""
    folder = Path(tempfile.mkdtemp(prefix="slurm-"))
    folder.chmod(0o755)
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o600)
    host, cores = socket.gethostname().partition(".")[0], os.cpu_count() or 1
    text = CONFIGURATION.format(host=host, folder=folder, cores=cores, memory=MEMORY)
    (folder / "slurm.conf").write_text(text)
    munge = [f"--{name}={folder}/munge.{name}" for name in ("socket", "key-file", "log-file", "pid-file", "seed-file")]
    munge[1] = f"--key-file={key}"
    PLACE.parent.mkdir(exist_ok=True)
    PLACE.symlink_to(folder / "slurm.conf")
    try:
        subprocess.run(["munged", "--force", *munge], check=True)
        subprocess.run(["slurmctld"], check=True)
        time.sleep(1.0)
        subprocess.run(["slurmd"], check=True)
        until = time.monotonic() + START
        while "idle" not in asked("sinfo", "--noheader", "--format=%T"):
            if time.monotonic() > until:
                raise TimeoutError(f"the node is not idle after {START:g} s; see {folder}/slurmctld.log")
            time.sleep(0.5)
        yield folder
    finally:
        subprocess.run(["scancel", "--me"], check=False)
        subprocess.run(["scontrol", "shutdown"], check=False)
        time.sleep(2.0)
        for name in ("slurmd.pid", "slurmctld.pid", "munge.pid-file"):
            if (folder / name).exists():
                subprocess.run(["kill", (folder / name).read_text().strip()], check=False, capture_output=True)
        PLACE.unlink()
        shutil.rmtree(folder, ignore_errors=True)


def asked(*command: str) -> str:
    """Return what one of Slurm's commands says."""
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


if __name__ == "__main__":
    if why := reason_against():
        sys.exit(why)
    with one_node_cluster() as place:
        input(f"Slurm runs, its logs are in {place}; Enter ends it. ")
