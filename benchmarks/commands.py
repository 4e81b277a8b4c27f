"""Whole commands beside the stages alone: what starting, planning, scheduling, recording and reporting add to them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks import ROOT
from benchmarks.line import Line
from benchmarks.measurement import Cost, cost_of_children, median_cost

SURFEXP = (sys.executable, "-m", "surfexp.commands.command_line")
# and how often each is run; the long ones once
EXPERIMENTS = {"quickstart": 3, "isospectral_drums": 1, "retrieval": 1}
QUICK_EXPERIMENTS = {"quickstart": 1}
FRESH, AGAIN, COMPILATION, SHORT, TINY = 1.3, 1.25, 12.0, 0.4, 0.06
TINY_STAGES, QUICK_TINY_STAGES = (10, 100, 1000, 4000), (10, 20)
PLAIN_STAGES, QUICK_PLAIN_STAGES = (10, 30, 100), (2, 4)
STAGES_ALONE = "all its stages in one process"
IN_ONE_PROCESS = """
import sys
from pathlib import Path
from surfexp.lab.plan.plan import read_plan
from surfexp.lab.running.stage import run_stage
path = Path(sys.argv[1])
plan = read_plan(path)
assert not any(run_stage(path, node.key, plan) for node in plan.stored)
"""
TINY_PLUGIN = """
import numpy as np
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.lab.registry.registry import register

@register("surface", "tiny")
def tiny(size: float = 1.0) -> Surface:
    \"\"\"One triangle.\"\"\"
    return Surface(TriangleMesh(size * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])))
"""
SHORT_COMMANDS = (("list",), ("info", "solver/newton"), ("--help",), ("run", "--help"), ("plan", "--no-such-option"))


def warm_up() -> None:
    """Nothing is measured in this process."""


def lines(quick: bool) -> list[Line]:
    """Return the lines of whole experiments, of tiny stages and of short commands."""
    experiments = QUICK_EXPERIMENTS if quick else EXPERIMENTS
    found = [line for name, runs in experiments.items() for line in _experiment(name, runs)]
    found += [_first_run_ever(), _tiny_stages(QUICK_TINY_STAGES if quick else TINY_STAGES)]
    found.append(_plain_snakemake(QUICK_PLAIN_STAGES if quick else PLAIN_STAGES))
    return found + [_short(words) for words in SHORT_COMMANDS]


def _experiment(name: str, runs: int) -> list[Line]:
    """A whole experiment in a new results folder, and without its results in one that was used, beside its stages."""
    fresh, again, alone = [], [], []
    for number in range(runs + 1):
        with TemporaryDirectory() as folder:
            results = Path(folder) / "results"
            run = [*SURFEXP, "run", f"experiment={name}", f"results={results}"]
            first = _cost(run)
            if not number:  # which compiles
                continue
            fresh.append(first)
            _without_results(results)
            again.append(_cost(run))
            _without_results(results)
            (plan,) = (results / "plans").glob("*.json")
            alone.append(_cost([sys.executable, "-c", IN_ONE_PROCESS, str(plan)]))
    rival = median_cost([(cost.cpu, cost.wall) for cost in alone])
    work = f"surfexp run experiment={name}"
    return [
        _beside(f"{work}, new results folder", FRESH, fresh, rival),
        _beside(f"{work}, results removed", AGAIN, again, rival),
    ]


def _without_results(results: Path) -> None:
    for folder in ("store", "events"):
        subprocess.run(["rm", "-r", str(results / folder)], check=True)


def _beside(work: str, most: float, costs: Sequence[Cost], rival: Cost) -> Line:
    ours = median_cost([(cost.cpu, cost.wall) for cost in costs])
    ratio = ours.cpu / rival.cpu
    told = f"{ours.cpu - rival.cpu:.1f} s of processor more than the stages, compiled code is there on both sides"
    return Line(work, STAGES_ALONE, f"≤ {most:g}×", f"{ratio:.2f}×", ratio <= most, ours, rival, told)


def _first_run_ever() -> Line:
    with TemporaryDirectory() as folder:
        environment = os.environ | {"XDG_CACHE_HOME": f"{folder}/cache"}
        costs = []
        for number in range(2):
            run = [*SURFEXP, "run", "experiment=quickstart", f"results={folder}/{number}"]
            costs.append(_cost(run, environment=environment))
    seconds = costs[0].cpu - costs[1].cpu
    told = f"the first run of a new user takes {costs[0].cpu:.1f} s of processor, the second {costs[1].cpu:.1f}"
    work, limit = "compilation in the first quickstart of a user", f"≤ {COMPILATION:g} s"
    return Line(work, "a limit", limit, f"{seconds:.3g} s", seconds <= COMPILATION, costs[0], accuracy=told)


def _tiny_stages(counts: Sequence[int]) -> Line:
    costs = [_cost_of_tiny([*SURFEXP, "run", "experiment=tiny"], count) for count in counts]
    most = counts[-2]
    cost = costs[-2]
    seconds = cost.cpu / most
    rates = ", ".join(f"{n:,} in {cost.wall:.3g} s" for n, cost in zip(counts, costs, strict=True))
    told = f"all of the command counted, its plan and its report too; wall: {rates}"
    work, limit = f"a tiny stage, over {most:,} of them", f"≤ {TINY:g} s"
    points = _points(counts, costs)
    met = seconds <= TINY
    limits = ("a limit", limit, f"{seconds:.3f} s", met)
    return Line(work, *limits, cost, accuracy=told, points=points, curve="surfexp run")


def _plain_snakemake(counts: Sequence[int]) -> Line:
    """The old way, one process a stage, for the figure."""
    command = [sys.executable, "-m", "snakemake", "-s", str(ROOT / "Snakefile"), "-c2", "--config", "experiment=tiny"]
    costs = [_cost_of_tiny(command, count) for count in counts]
    seconds = costs[-1].cpu / counts[-1]
    rates = ", ".join(f"{n:,} in {cost.wall:.3g} s" for n, cost in zip(counts, costs, strict=True))
    work = f"a tiny stage under plain snakemake, over {counts[-1]:,} of them"
    points = _points(counts, costs)
    told = f"a process for each stage; wall: {rates}"
    seen = ("no limit", "–", f"{seconds:.2f} s", True)
    return Line(work, *seen, costs[-1], accuracy=told, points=points, curve="plain snakemake")


def _points(counts: Sequence[int], costs: Sequence[Cost]) -> tuple[tuple[float, float], ...]:
    return tuple((float(count), cost.wall) for count, cost in zip(counts, costs, strict=True))


def _cost_of_tiny(command: Sequence[str], stages: int) -> Cost:
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "plugins" / "surface").mkdir(parents=True)
        (folder / "plugins" / "surface" / "tiny.py").write_text(TINY_PLUGIN)
        (folder / "conf" / "experiment").mkdir(parents=True)
        sizes = [1.0 + number for number in range(stages)]
        experiment = {"title": "Tiny", "target": "surface", "surface": "tiny", "grid": {"surface.size": sizes}}
        (folder / "conf" / "experiment" / "tiny.yaml").write_text(json.dumps(experiment))
        cost = _cost(command, folder)
        if len(list(folder.glob("results/store/surface/*/record.json"))) != stages:
            raise RuntimeError(f"{' '.join(command)} has not made {stages} stages")
    return cost


def _short(words: Sequence[str]) -> Line:
    command = [*SURFEXP, *words]
    _cost(command)
    cost = median_cost([(cost.cpu, cost.wall) for cost in (_cost(command) for _ in range(5))])
    return Line(f"surfexp {' '.join(words)}", "a limit", f"≤ {SHORT:g} s", f"{cost.cpu:.3f} s", cost.cpu <= SHORT, cost)


def _cost(command: Sequence[str], folder: Path | None = None, environment: dict[str, str] | None = None) -> Cost:
    """What a command takes; exit codes 2 and 3 are answers too."""
    run = partial(subprocess.run, command, cwd=folder, env=environment, capture_output=True, check=False)
    return cost_of_children(run)
