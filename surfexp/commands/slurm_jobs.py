"""Stages as jobs of Slurm: what they ask for, why they wait, and how those ended that left no word."""

from __future__ import annotations

import csv
import math
import re
import shutil
import subprocess
import time
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean
from typing import Any

import yaml

from surfexp.lab.errors import UserError
from surfexp.lab.plan.outcome import read_event
from surfexp.lab.plan.plan import Node, stored_inputs

COMMANDS = ("sbatch", "squeue")
PAUSE = 20.0
LEAST_MEMORY, LEAST_MINUTES = 2000.0, 10.0
# a job costs about five seconds, so that this much work makes them a few per cent
SECONDS_TOGETHER, MOST_TOGETHER = 120.0, 100
# what passes by itself
PATIENCE = {"None", "Priority", "Resources", "Dependency", "BeginTime", "JobArrayTaskLimit", "Cleaning"}
# what the executor says of a job is lost where it was one of a group; its log is named in any case
JOB_LOG = re.compile(r"(/\S+/slurm_logs/\S+/([\d_]+)\.log)")
RESULT = re.compile(r"output: .*/store/\w+/([0-9a-f]+)/record\.json$", re.MULTILINE)


def settings_of(profile: Path) -> dict[str, Any]:
    """Return what a Snakemake profile sets."""
    settings: dict[str, Any] = {}
    for file in sorted(profile.glob("config*.yaml")):
        settings |= yaml.safe_load(file.read_text()) or {}
    return settings


def check_slurm(profile: str) -> None:
    """Refuse a profile of Slurm where its commands are not; Snakemake would try for minutes without a word."""
    if missing := [name for name in COMMANDS if shutil.which(name) is None]:
        raise UserError(
            f"profile {profile} submits jobs to Slurm, but {' and '.join(missing)} cannot be found here: "
            "run it where sbatch works, or without profile= on this machine"
        )


def requests(
    nodes: Mapping[str, Node], missing: Iterable[Node], results: Path, settings: Mapping[str, Any]
) -> list[str]:
    """Return Snakemake's arguments that ask for memory and time, and put small stages together, as was measured before.

    A kind asks for twice the peak memory and three times the seconds that it took in the results folder, and never for
    less than 2 GB. One that took seconds asks for a minute, others for ten at least: the next surface may be larger
    than all before it. As many of the small ones are a job as two minutes of work are. What the profile says goes
    first.

    Parameters
    ----------
    nodes : dict of str to Node
        All stages of the plan.
    missing : iterable of Node
        Those to be run.
    results : path
    settings : dict
        Of the profile.

    Returns
    -------
    list of str
        Empty where nothing was measured.
    """
    wanted = {node.key: node for node in missing}
    measured = {kind: taken for kind in {node.kind for node in wanted.values()} if (taken := _taken(results, kind))}
    arguments: list[str] = []
    if measured and "set-resources" not in settings:
        arguments.append("--set-resources")
        for kind, taken in sorted(measured.items()):
            arguments += [f"{kind}:mem_mb={taken.megabytes}", f"{kind}:runtime={taken.minutes}"]
    if measured and "group-components" not in settings:
        arguments += _batches(nodes, wanted, measured, dict(settings.get("groups", {})))
    return arguments


@dataclass(frozen=True)
class Taken:
    """What the stages of a kind took: the largest peak memory in MB, the most and the mean seconds."""

    memory: float
    longest: float
    mean: float

    @property
    def small(self) -> bool:
        """Whether submission would cost a good part of it."""
        return 3.0 * self.longest <= 60.0

    @property
    def megabytes(self) -> int:
        """What to ask for."""
        return math.ceil(max(LEAST_MEMORY, 2.0 * self.memory))

    @property
    def minutes(self) -> int:
        """What to ask for."""
        return 1 if self.small else math.ceil(max(LEAST_MINUTES, 3.0 * self.longest / 60.0))


def _taken(results: Path, kind: str) -> Taken | None:
    found = [peak for file in (results / "logs" / kind).glob("*.benchmark.tsv") if (peak := _measured(file))]
    if not found:
        return None
    memory, seconds = zip(*found, strict=True)
    return Taken(max(memory), max(seconds), fmean(seconds))


def _batches(
    nodes: Mapping[str, Node], missing: Mapping[str, Node], measured: Mapping[str, Taken], groups: dict[str, str]
) -> list[str]:
    """Arguments that make a group of each small kind that has none, and put groups of small kinds into few jobs.

    Two groups that each wait for the other would be a circle once theirs are put together: such stay as they are.
    """
    from networkx import DiGraph, strongly_connected_components

    kinds = {node.kind for node in missing.values()}
    groups |= {kind: kind for kind in sorted(kinds) if kind in measured and measured[kind].small and kind not in groups}
    group = {kind: groups.get(kind, kind) for kind in kinds}
    before = {
        (group[missing[key].kind], group[node.kind])
        for node in missing.values()
        for key in stored_inputs(nodes, node.key)
        if key in missing
    }
    circles = [part for part in strongly_connected_components(DiGraph(before)) if len(part) > 1]
    together: list[str] = []
    for name in dict.fromkeys(groups.values()):
        members = [kind for kind in sorted(kinds) if groups.get(kind) == name]
        small = members and all(kind in measured and measured[kind].small for kind in members)
        if small and not any(name in part for part in circles):
            work = sum(measured[kind].mean for kind in members)
            together.append(f"{name}={max(1, min(MOST_TOGETHER, int(SECONDS_TOGETHER / max(work, 1e-3))))}")
    if not together:
        return []
    named = [f"{kind}={name}" for kind, name in groups.items()]
    return ["--groups", *named, "--group-components", *together]


def _measured(file: Path) -> tuple[float, float] | None:
    """Peak memory in MB and seconds of a stage that Snakemake has timed."""
    try:
        (row,) = csv.DictReader(file.open(), delimiter="\t")
        return float(row["max_rss"]), float(row["s"])
    except (OSError, ValueError, KeyError, TypeError):  # shorter than a measurement can be: "NA"
        return None


class Queue:
    """Asks now and then why jobs of this user wait, and says once what does not pass by itself."""

    def __init__(self) -> None:
        self.asked, self.said = time.monotonic(), set[str]()

    def __call__(self) -> list[str]:
        """Return lines that were not said before."""
        if time.monotonic() - self.asked < PAUSE:
            return []
        self.asked = time.monotonic()
        reasons = Counter(_lines("squeue", "--me", "--noheader", "--states=PENDING", "--format=%r"))
        lines = [
            f"surfexp: warning: waiting in Slurm's queue, {count} of your jobs: {reason}{_nodes(reason)}; the run goes on "
            "when that has changed, Ctrl-C ends it"
            for reason, count in reasons.items()
            if reason not in PATIENCE and reason not in self.said
        ]
        self.said |= reasons.keys()
        return lines


def _nodes(reason: str) -> str:
    """Which nodes are away and why, where that is the reason."""
    if not re.search("node", reason, re.IGNORECASE):
        return ""
    away = dict.fromkeys(_lines("sinfo", "--noheader", "--list-reasons", "--format=%N: %E"))
    return f" ({', '.join(away)})" if away else ""


def _lines(*command: str) -> list[str]:
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PAUSE, check=False)  # noqa: S603, Slurm's own
    except (OSError, subprocess.TimeoutExpired):
        return []
    return [line.strip() for line in done.stdout.splitlines() if line.strip()]


def tell_of_ended(log: str, missing: Iterable[Node], results: Path) -> None:
    """Write how the Slurm job ended, from Snakemake's output, of each stage that left no word of its own."""
    from surfexp.lab.running.stage_process import write_death

    ended = ended_jobs(log)
    for node in missing:
        if node.key in ended and unexplained(read_event(results, node.kind, node.key)):
            write_death(results, node, ended[node.key])


def unexplained(event: Mapping[str, Any]) -> bool:
    """Whether a stage left no word of its own: no event, or one of a signal, as Slurm's that end a job."""
    return not event or "killed by signal" in str(event.get("failure"))


def ended_jobs(log: str) -> dict[str, str]:
    """Return how the Slurm jobs of stages ended that did not succeed, by the stages' keys, from Snakemake's output."""
    found: dict[str, str] = {}
    for block in re.split(r"\n(?=\S)", log):
        if "Error in" in block and (ended := JOB_LOG.search(block)):
            place, job = ended.groups()
            found |= dict.fromkeys(RESULT.findall(block), f"its job {job} in Slurm {_state(job)}; see {place}")
    return found


def _state(job: str) -> str:
    (state, *_) = _lines("squeue", "--noheader", "--states=all", f"--jobs={job}", "--format=%T") or [""]
    return f"ended as {state}" if state else "ended without a result"
