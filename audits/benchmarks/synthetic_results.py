"""Results folders as large as one wishes, made by hand: what lies around the methods is measured without calling one."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.figures.figure import Figure
from surfexp.lab.experiment.configuration import Context, expand
from surfexp.lab.plan.outcome import event_path
from surfexp.lab.plan.plan import Node, Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.lab.store import store
from surfexp.lab.store.kinds import KINDS
from surfexp.variational.solution import Solution

TOLERANCES = 100
ITERATIONS = 5


def sweep(leaves: int) -> Context:
    """Return the configuration of a race of one solver: seeds of the noise times at most 100 tolerances."""
    tolerances = [10.0 ** -(1.0 + step / 20.0) for step in range(min(leaves, TOLERANCES))]
    return {
        "experiment": "synthetic",
        "title": "A sweep",
        "columns": ["relative_gap", "rmse", "iterations"],
        "surface": "cup",
        "image": {"name": "picture", "noise": 40.0},
        "operator": "fem",
        "model": "rof",
        "solver": "primal_dual",
        "grid": {"image.seed": list(range(leaves // len(tolerances))), "solver.tolerance": tolerances},
    }


def plan_of(configuration: Context, results: Path) -> Plan:
    """Plan a configuration, whose results lie in a folder."""
    open_catalogue(Path.cwd())
    return make_plan(expand({**configuration, "results": str(results)}))


def fill(plan: Plan, results: Path) -> None:
    """Store a result without contents, and an event, for every stage of a plan that has none."""
    random = np.random.default_rng(0)
    for node in plan.stored:
        if not store.is_done(results, node.kind, node.key):
            store.save(results, node.kind, node.key, _result(node, random))
            event = {"kind": node.kind, "plugin": node.plugin, "failure": "", "seconds": random.uniform(0.1, 9.0)}
            event |= {"peak_memory_mb": random.uniform(100.0, 300.0), "warnings": []}
            store.write_text(event_path(results, node.kind, node.key), json.dumps(event))


def _result(node: Node, random: np.random.Generator) -> Any:
    if node.kind == "figure":
        return Figure(np.zeros((2, 2, 3), np.uint8), "nothing is drawn", "Nothing")
    if node.kind == "solver":
        history = {"iteration": np.arange(ITERATIONS) * 10, "gap": random.uniform(size=ITERATIONS)}
        metrics = {"relative_gap": 1e-5, "iterations": 40.0, "converged": 1.0, "rmse": random.uniform(5.0, 20.0)}
        return Solution(np.zeros(3), 1.0, history=history, metrics=metrics)
    return _hollow(KINDS[node.kind].result)


def _hollow(result: type) -> Any:
    """An instance of a result class that holds nothing, which the store reads as a result of the kind."""
    empty = object.__new__(result)
    for field in dataclasses.fields(result):
        object.__setattr__(empty, field.name, {"metrics": {}, "notes": ()}.get(field.name))
    return empty


def fill_experiment(experiment: str, results: Path) -> Plan:
    """Store a result without contents for every stage of an experiment; return its plan."""
    from surfexp.lab.composition.launch import launch

    plans: list[Plan] = []
    launch([f"experiment={experiment}", f"results={results}"], plans.append)
    fill(plans[0], results)
    return plans[0]
