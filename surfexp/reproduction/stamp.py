"""What a page of verdicts rests on: the commit, the digests of numerics and experiments, the machine, what it took."""

from __future__ import annotations

import platform
import re
import subprocess
import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path

import yaml

from surfexp.lab.digests import digest
from surfexp.lab.plan.code_digests import code_closure
from surfexp.lab.plan.outcome import event_path, outcome
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.source_facts import source_facts
from surfexp.lab.registry import registry
from surfexp.lab.registry.folders import package_folder
from surfexp.lab.registry.loading import load_all
from surfexp.lab.running.machine import machine
from surfexp.reproduction.pages import CHAPTERS_FOLDER, INDEX, read_pages

STATE = re.compile(r"^State: .*$", re.MULTILINE)
STAMP = re.compile(r"numerics ([0-9a-f]{20}), experiments ([0-9a-f]{20})")
SECTION = re.compile(r"`surfexp run experiment=([\w.-]+)`; state ([0-9a-f]{20})")
PAGES = Path("docs")


def state_of_code() -> tuple[str, str]:
    """Digests of the numerics (all that plugins reach, without comments) and of the experiments (their parsed files)."""
    load_all(Path("/nonexistent"))
    plugins = {method.file for method in registry.PLUGINS.values()}
    sources = {source for file in plugins for source in code_closure(file)[0]}
    files = _experiment_files()
    experiments = [[file.name, yaml.safe_load(file.read_text(encoding="utf-8"))] for file in files]
    return digest(sorted(source_facts(source).meaning for source in sources)), digest(experiments)


def state_of_plan(plan: Plan) -> str:
    """Digest of all that the verdicts of an experiment follow from: the keys of its stages, and what it claims."""
    return digest([sorted(plan.nodes), plan.settings.title, plan.settings.claims])


def state_line() -> str:
    """The line of a page that says of which commit, numerics and experiments it is."""
    numerics, experiments = state_of_code()
    return f"State: commit {commit_of_page()}, numerics {numerics}, experiments {experiments}."


def cost(plans: Mapping[str, Plan], results: Path) -> str:
    """When and where some experiments were computed, and what their stages took."""
    nodes = {node.key: node for plan in plans.values() for node in plan.stored}
    outcomes = [outcome(results, node) for node in nodes.values()]
    hours = sum(item.seconds or 0.0 for item in outcomes) / 3600.0
    memory = max((item.peak_memory_mb or 0.0 for item in outcomes), default=0.0) / 1024.0
    failed = sum(bool(item.failure) for item in outcomes)
    events = [event_path(results, node.kind, node.key) for node in nodes.values()]
    moments = [event.stat().st_mtime for event in events if event.exists()] or [0.0]
    span = (max(moments) - min(moments)) / 3600.0
    return (
        f"{datetime.now(UTC):%Y-%m-%d}, {machine()}, Python {platform.python_version()}; "
        f"{len(nodes)} stages, {failed} without result, "
        f"{hours:.2f} processor hours in methods, {span:.1f} hours from the end of the first to that of the last, "
        f"peak memory of a stage {memory:.1f} GB."
    )


def stale_experiments(page: str) -> list[str]:
    """The experiments whose section is not of the present keys and claims, or is missing; each is planned for it."""
    names = [file.stem for file in _experiment_files() if file.parent.name == "experiment"]
    return [name for name in names if is_stale(name, page)]


def is_stale(experiment: str, page: str) -> bool:
    """Whether an experiment makes claims and its section is not of the present keys and claims, or is missing."""
    from surfexp.lab.composition.launch import launch

    plans: list[Plan] = []
    launch([f"experiment={experiment}"], plans.append)
    return bool(plans[0].settings.claims) and dict(SECTION.findall(page)).get(experiment) != state_of_plan(plans[0])


def staleness(page: str) -> str:
    """Why a page is stale, empty where it is of the present numerics and experiments.

    Other digests alone say nothing of the verdicts, since a change may be in what no experiment calls: then the keys of all
    stages decide.
    """
    found = STAMP.search(page)
    if found is None:
        return "it does not say of which state of the code it is"
    if found.groups() == state_of_code():
        return ""
    stale = stale_experiments(page)
    shown = f"{', '.join(stale[:5])}{', ...' if len(stale) > 5 else ''}"
    return (
        f"{len(stale)} experiments have changed ({shown})"
        if stale
        else "its state is another one, and no stage changed"
    )


def renew(folder: Path) -> None:
    """Write the present state into the index of a folder, where every section of its pages is still true.

    Raises
    ------
    ValueError
        If a section is stale.
    """
    if stale := stale_experiments(read_pages(folder)):
        raise ValueError(
            f"{len(stale)} experiments have changed ({', '.join(stale)}); make reproduction-changed runs them"
        )
    index = folder / INDEX
    index.write_text(STATE.sub(state_line(), _read(index)), encoding="utf-8")


def commit_of_page() -> str:
    """The commit, and how many files differ from it; the pages themselves, which the run writes, aside."""

    def git(*arguments: str) -> str:
        command = ["git", *arguments]
        return subprocess.run(  # noqa: S603, git with constant arguments, no shell
            command, capture_output=True, text=True, check=False
        ).stdout.strip()

    own = (str(PAGES / INDEX), f"{PAGES / CHAPTERS_FOLDER}/")
    status = git("status", "--porcelain", "--untracked-files=no").splitlines()
    changed = [line for line in status if not any(name in line for name in own)]
    commit = git("rev-parse", "--short=12", "HEAD") or "unknown (not a checkout)"
    return f"{commit} with {len(changed)} changed files" if changed else commit


def _experiment_files() -> list[Path]:
    return sorted(package_folder("surfexp.conf").rglob("*.yaml"))


def _read(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""


def main(arguments: list[str]) -> int:
    """What `make` asks.

    `state` prints the digest that names the results folder, `stale` the names of experiments to run again, `check` a warning
    line when the page is stale; `renew` writes the present state into a page whose stages are all unchanged.
    """
    if arguments == ["state"]:
        print(digest(state_of_code())[:12])
    elif arguments == ["stale"]:
        print(*stale_experiments(read_pages(PAGES)))
    elif arguments == ["renew"]:
        try:
            renew(PAGES)
        except ValueError as error:
            print(error, file=sys.stderr)
            return 1
    elif reason := staleness(read_pages(PAGES)):
        way = "python -m surfexp.reproduction.stamp renew" if "no stage" in reason else "make reproduction-changed"
        print(f"warning: {PAGES / INDEX} is stale: {reason}; {way} renews it")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
