"""Seconds of several kinds of machine do not compare: no best, no ranking, and the page and the terminal say so."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from audits.benchmarks.synthetic_results import fill, plan_of
from surfexp.contract.metric import Metric
from surfexp.lab.experiment.claim import read_claims
from surfexp.lab.plan.outcome import event_path
from surfexp.lab.plan.plan import Leaf
from surfexp.lab.running.machine import machine
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row, rows_of
from surfexp.report.page import write_report
from surfexp.report.ranking.trials import trials_of
from surfexp.report.verdict import judge

METRICS = {"rmse": Metric("error", "mm", "lower")}
RACE = {
    "experiment": "race",
    "columns": ["rmse", "seconds"],
    "timing": True,
    "surface": "cup",
    "image": {"name": "picture", "noise": 40.0},
    "solver": "primal_dual",
    "model": "rof",
    "grid": {"image.seed": [0, 1, 2], "operator": ["fem", "libigl"]},
}


def timed(kinds: list[str]) -> Comparison:
    rows = []
    for problem in range(6):
        for place, method in enumerate(("newton", "primal_dual")):
            leaf = Leaf(f"{method}{problem}", "", {"target": "solver", "timing": True})
            parameters = {"image.seed": problem, "solver.name": method}
            data, seconds = frozenset([f"image {problem}"]), 1.0 + place + problem
            rows.append(Row(leaf, parameters, {"rmse": seconds}, seconds, data=data, machine=kinds[place]))
    return Comparison("", "", rows, ["rmse", "seconds"], METRICS)


def test_seconds_have_a_best_and_a_ranking_on_machines_of_one_kind_alone() -> None:
    one, two = timed(["old", "old"]), timed(["old", "new"])
    assert one.meaning("seconds").better == "lower" and two.meaning("seconds").better == ""
    assert any(name == "seconds" for name, _ in one.best) and not any(name == "seconds" for name, _ in two.best)
    assert {found.metric for found in trials_of(one)} == {"rmse", "seconds"}
    assert {found.metric for found in trials_of(two)} == {"rmse"}
    # a row whose event does not say where it ran is of a kind of its own; one without seconds is of none
    assert timed(["old", ""]).machines == {"old": 6, "unknown": 6}
    assert Comparison("", "", [replace(row, seconds=None) for row in two.rows], []).machines == {}


def test_a_claim_compares_seconds_of_one_kind_of_machine_alone() -> None:
    claim = {
        "claim": "one is quicker",
        "quantity": {"ratio": "seconds"},
        "rows": [{"solver.name": "primal_dual"}, {"solver.name": "newton"}],
        "between": [1.0, None],
        "because": "quicker at all",
    }
    one, two = (judge(read_claims([claim]), timed(kinds).rows)[0] for kinds in (["old", "old"], ["old", "new"]))
    assert one.verdict == "holds"
    assert two.verdict == "not computed" and two.why == "seconds of 2 kinds of machine do not compare: new, old"


def test_the_machine_of_a_stage_is_in_its_event_and_a_page_tells_kinds_apart(tmp_path: Path) -> None:
    plan = plan_of(RACE, tmp_path)
    fill(plan, tmp_path)
    for place, leaf in enumerate(plan.leaves):
        file = event_path(tmp_path, "solver", leaf.key)
        event = json.loads(file.read_text()) | {"seconds": 1.0, "machine": machine() if place else "another, 64 cores"}
        file.write_text(json.dumps(event))
    assert [row.machine for row in rows_of(plan, tmp_path)] == ["another, 64 cores", *[machine()] * 5]
    page = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "seconds are of 2 kinds of machine" in page and "another, 64 cores (1 row)" in page
