"""What a page of verdicts rests on: the commit, the digests of numerics and experiments, the machine, what it took."""

from __future__ import annotations

import os
import platform
import re
import subprocess
import sys
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path

import yaml

from surfexp.catalogue.source_facts import source_facts
from surfexp.workflow import registry
from surfexp.workflow.fingerprint import code_closure, digest
from surfexp.workflow.outcome import event_path, outcome
from surfexp.workflow.plan import Plan

STAMP = re.compile(r"numerics ([0-9a-f]{20}), experiments ([0-9a-f]{20})")
PAGE = Path("docs/reproduction.md")


def state_of_code() -> tuple[str, str]:
    """Digests of the numerics (all that plugins reach, without comments) and of the experiments (their parsed files)."""
    registry.load_all(Path("/nonexistent"))
    plugins = {method.file for method in registry.PLUGINS.values()}
    sources = {source for file in plugins for source in code_closure(file)[0]}
    files = sorted(registry.package_folder("surfexp.conf").rglob("*.yaml"))
    experiments = [[file.name, yaml.safe_load(file.read_text(encoding="utf-8"))] for file in files]
    return digest(sorted(source_facts(source).meaning for source in sources)), digest(experiments)


def stamp(plans: Iterable[Plan], results: Path) -> str:
    """Two lines for the head of the page: its state, and what its stages took."""
    numerics, experiments = state_of_code()
    nodes = {node.key: node for plan in plans for node in plan.stored}
    outcomes = [outcome(results, node) for node in nodes.values()]
    hours = sum(item.seconds or 0.0 for item in outcomes) / 3600.0
    memory = max((item.peak_memory_mb or 0.0 for item in outcomes), default=0.0) / 1024.0
    failed = sum(bool(item.failure) for item in outcomes)
    events = [event_path(results, node.kind, node.key) for node in nodes.values()]
    moments = [event.stat().st_mtime for event in events if event.exists()] or [0.0]
    span = (max(moments) - min(moments)) / 3600.0
    return (
        f"State: commit {_commit()}, numerics {numerics}, experiments {experiments}.\n\n"
        f"Run: {datetime.now(UTC):%Y-%m-%d}, {_machine()}; {len(nodes)} stages, {failed} without result, "
        f"{hours:.1f} processor hours in methods, {span:.1f} hours from the end of the first to that of the last, "
        f"peak memory of a stage {memory:.1f} GB."
    )


def staleness(page: str) -> str:
    """Why a page is stale, empty where it is of the present numerics and experiments."""
    found = STAMP.search(page)
    if found is None:
        return "it does not say of which state of the code it is"
    parts = zip(("numerics", "experiments"), found.groups(), state_of_code(), strict=True)
    changed = [f"{name} were {old}, are {new}" for name, old, new in parts if old != new]
    return "; ".join(changed)


def _commit() -> str:
    def git(*arguments: str) -> str:
        command = ["git", *arguments]
        return subprocess.run(  # noqa: S603, git with constant arguments, no shell
            command, capture_output=True, text=True, check=False
        ).stdout.strip()

    # the page itself is written by the run
    changed = [
        line for line in git("status", "--porcelain", "--untracked-files=no").splitlines() if str(PAGE) not in line
    ]
    commit = git("rev-parse", "--short=12", "HEAD") or "unknown (not a checkout)"
    return f"{commit} with {len(changed)} changed files" if changed else commit


def _machine() -> str:
    """Kind of processor and number of cores; nothing that names the machine."""
    kinds = re.findall(r"^model name\s*: (.*)$", _read(Path("/proc/cpuinfo")), re.MULTILINE)
    return f"{kinds[0] if kinds else platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"


def _read(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""


def main(arguments: list[str]) -> int:
    """`state`: print the digest that names the results folder; `check`: a warning line when the page is stale."""
    if arguments == ["state"]:
        print(digest(state_of_code())[:12])
    elif reason := staleness(_read(PAGE)):
        print(f"warning: {PAGE} is stale: {reason}; make reproduction renews it")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
