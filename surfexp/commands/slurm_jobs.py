"""Stages as jobs of Slurm: what they ask for, why they wait, and how those ended that left no word."""

from __future__ import annotations

import csv
import math
import re
import subprocess
import time
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import yaml

PAUSE = 20.0
LEAST_MEMORY, LEAST_MINUTES = 2000.0, 10.0
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


def requests(results: Path, kinds: Iterable[str]) -> list[str]:
    """Return Snakemake's arguments that ask for memory and time of stages by what their kind took before, if anything.

    Twice the peak memory and three times the seconds, and never less than 2 GB and 10 minutes: the next surface may be
    larger than all before it.
    """
    found = []
    for kind in dict.fromkeys(kinds):
        peaks = [_measured(file) for file in (results / "logs" / kind).glob("*.benchmark.tsv")]
        if known := [peak for peak in peaks if peak]:
            memory = max(LEAST_MEMORY, 2.0 * max(peak[0] for peak in known))
            minutes = max(LEAST_MINUTES, 3.0 * max(peak[1] for peak in known) / 60.0)
            found += [f"{kind}:mem_mb={math.ceil(memory)}", f"{kind}:runtime={math.ceil(minutes)}"]
    return ["--set-resources", *found] if found else []


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
