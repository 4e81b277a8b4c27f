"""Processes killed at random moments, and drivers side by side: the next run ends with the same bytes."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from audits.torture.case import HUNG, REPAIRED, RIGHT, WRONG, Ended
from audits.torture.laboratory import end, run, start, store_bytes, working_folder

COUNT, ROUNDS, DRIVERS = 200, 20, 8
CHAIN = 5
VICTIMS = ("driver", "snakemake", "worker", "any")


def kills(seed: int = 0, count: int = COUNT) -> Iterator[Ended]:
    """Kill the driver, Snakemake, a worker or any process of a run, from its first moment to its last.

    Every fifth run that continues a killed one may end, and has to end with the bytes of a run that nobody killed.
    """
    rng = random.Random(seed)
    with working_folder() as folder:
        begin = time.monotonic()
        run(folder, "run", "experiment=small")
        length, intact = time.monotonic() - begin, store_bytes(folder / "results")
        done = 0
        while done < count:
            shutil.rmtree(folder / "results", ignore_errors=True)
            killed, reach = [], length
            for _ in range(min(CHAIN, count - done)):
                found, seconds = _killed(folder, rng, reach)
                if found:
                    killed.append(found)
                else:  # what is left to do takes no longer
                    reach = seconds
            again = run(folder, "run", "experiment=small")
            same = store_bytes(folder / "results") == intact
            for name, first, left in killed:
                done += 1
                yield _judged(name, first, left, again.code, again.error, same)


Killed = tuple[str, int | None, list[str]]


def _killed(folder: Path, rng: random.Random, length: float) -> tuple[Killed | None, float]:
    """Begin or continue a run and kill one of its processes: what was killed, the exit code, what is left behind.

    None where the run, which may have had little left to do, ended before; and the seconds that it took.
    """
    begin = time.monotonic()
    process = start(folder, "run", "experiment=small")
    moment = rng.uniform(0.1, 1.0) * length
    with suppress(subprocess.TimeoutExpired):
        process.wait(moment)
        end(process)
        return None, time.monotonic() - begin
    found = _kill(process, rng)
    return (f"{found} after {moment:.1f} s", end(process).code, _left(folder)), time.monotonic() - begin


def _judged(name: str, first: int | None, left: list[str], code: int | None, error: str, same: bool) -> Ended:
    if first is None or code is None:
        return Ended("kill", name, HUNG, "the killed run did not end" if first is None else "the next run did not end")
    if left:
        return Ended("kill", name, WRONG, f"left behind: {left[0][:150]}")
    if code != 0 or not same:
        return Ended(
            "kill", name, WRONG, f"the next run: exit {code}, {'' if same else 'another store, '}{error[-200:]}"
        )
    return Ended("kill", name, REPAIRED, "")


def _kill(process: subprocess.Popen[str], rng: random.Random) -> str:
    """Send SIGKILL to the driver, or to a process below it; what was killed."""
    victim, below = rng.choice(VICTIMS), _below(process.pid)
    wanted = {"snakemake": "snakemake", "worker": "stage_server", "any": ""}.get(victim)
    found = [pid for pid, command in below.items() if wanted is not None and wanted in command]
    chosen = rng.choice(found) if found else process.pid
    with suppress(ProcessLookupError):
        os.kill(chosen, signal.SIGKILL)
    return victim if found else "driver"


def _below(parent: int) -> dict[int, str]:
    """Command lines of all processes below one."""
    listed = subprocess.run(["ps", "-eo", "pid=,ppid=,args="], capture_output=True, text=True, check=False).stdout
    rows = [line.split(None, 2) for line in listed.splitlines()]
    found: dict[int, str] = {}
    parents = {parent}
    while parents:
        children = {
            int(pid): args for pid, ppid, *rest in rows for args in [rest[0] if rest else ""] if int(ppid) in parents
        }
        found |= children
        parents = set(children)
    return found


def _left(folder: Path, seconds: float = 5.0) -> list[str]:
    """Processes that still work in the folder some seconds after the run."""
    limit = time.monotonic() + seconds
    while True:
        found = []
        for entry in Path("/proc").glob("[0-9]*"):
            try:
                if (entry / "cwd").readlink() == folder and int(entry.name) != os.getpid():
                    found.append((entry / "cmdline").read_text().replace("\0", " "))
            except OSError:
                continue
        if not found or time.monotonic() > limit:
            return found
        time.sleep(0.1)


def drivers(rounds: int = ROUNDS, count: int = DRIVERS) -> Iterator[Ended]:
    """Several runs at once on one results folder: each ends well or says that another one works there."""
    with working_folder() as folder:
        run(folder, "run", "experiment=small")
        intact = store_bytes(folder / "results")
        for number in range(rounds):
            shutil.rmtree(folder / "results")
            processes = [start(folder, "run", "experiment=small") for _ in range(count)]
            ended = [end(process) for process in processes]
            same = store_bytes(folder / "results") == intact
            codes = [done.code for done in ended]
            if None in codes:
                yield Ended("drivers", f"round {number}", HUNG, f"exit codes {codes}")
            elif set(codes) != {0} or not same:
                worst = next((done.error[-200:] for done in ended if done.code), "another store")
                yield Ended("drivers", f"round {number}", WRONG, f"exit codes {codes}: {worst}")
            else:
                yield Ended("drivers", f"round {number}", RIGHT, "")
