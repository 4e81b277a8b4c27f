"""The benchmarks measure both sides alike, say so, and run at small sizes."""

from __future__ import annotations

import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from audits.benchmarks.__main__ import SECTIONS
from audits.benchmarks.convex_problem import Excess, Recorded
from audits.benchmarks.large_mesh import _command
from audits.benchmarks.line import Line, race
from audits.benchmarks.measurement import Cost, IterationClock, least_count, measure, measure_both
from audits.benchmarks.record import Record, load, save
from audits.benchmarks.table import page
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.separable_quadratic import convex_chan_vese
from surfexp.variational.solvers.primal_dual import primal_dual

ROOT = Path(__file__).resolve().parents[2]
GROUPS = (
    "denoising",
    "slopes",
    "segmentation",
    "parametrization",
    "scaling",
    "threads",
    "nodal_domains",
    "assembly",
    "skeleton",
    "growth",
    "brain_modes",
    "hierarchy",
    "nulls",
    "permutations",
    "waiting",
    "whole_calls",
    "large_mesh",
    "commands",
    "cohort",
)


def test_sections_that_were_not_run_are_taken_over(tmp_path: Path) -> None:
    def record(result: str, numerics: str) -> Record:
        return Record(
            (Line("work", "a limit", "≤ 2 s", result, True),), 1.0, f"Python of {result}", numerics, "2020-01-01"
        )

    old = {"First": {"one": record("1 s", "a" * 20)}, "Second": {"two": record("2 s", "b" * 20)}}
    both = page(old)
    assert page({"First": {}, "Second": {}}, both) == both
    renewed = page({"First": {}, "Second": {"two": record("3 s", "c" * 20)}}, both)
    assert renewed.count("| 1 s |") == renewed.count("| 3 s |") == 1 and "| 2 s |" not in renewed
    assert "Python of 1 s" in renewed and "Python of 3 s" in renewed
    assert f"| one | 2020-01-01 | {'a' * 20} |" in renewed and f"| two | 2020-01-01 | {'c' * 20} |" in renewed
    assert "b" * 20 not in renewed


def test_the_page_can_be_taken_over_whole() -> None:
    text = (ROOT / "BENCHMARKS.md").read_text(encoding="utf-8")
    assert page({heading: {} for heading in SECTIONS}, text) == text


@pytest.mark.parametrize("least", [1, 2, 57, 117, 118, 160])
def test_bisection_finds_the_least_count(least: int) -> None:
    asked: list[int] = []

    def enough(count: int) -> bool:
        asked.append(count)
        return count >= least

    assert least_count(enough, 0, 160) == least
    assert len(asked) <= 8 and 160 not in asked and 0 not in asked


def test_both_sides_run_in_turn_and_equally_often(monkeypatch: pytest.MonkeyPatch) -> None:
    order: list[str] = []
    (ours, cost), (theirs, their_cost) = measure_both(lambda: order.append("ours"), lambda: order.append("theirs"), 3)
    assert order == ["theirs", "ours"] * 3 and cost.runs == their_cost.runs == 3
    assert ours is None and theirs is None
    monkeypatch.setattr("audits.benchmarks.measurement.LONG", -1.0)
    assert [side[1].runs for side in measure_both(lambda: 1, lambda: 2, 3)] == [1, 1]
    assert measure(lambda: 5, 3) == (5, measure(lambda: 5, 3)[1]) or measure(lambda: 5, 3)[1].runs == 1


def test_a_line_refuses_medians_of_unequal_numbers_of_runs() -> None:
    with pytest.raises(ValueError, match="median of 3 runs, the rival of 1"):
        race("work", "rival", 2.0, Cost(1.0, 1.0, 3), Cost(4.0, 4.0, 1), "")
    line = race("work", "rival", 2.0, Cost(1.0, 1.5, 3), Cost(4.0, 4.5, 3), "alike")
    assert line.result == "4.0×" and line.verdict == "met"
    assert race("work", "rival", 2.0, Cost(1.0, 1.0), Cost(4.0, 4.0), "", fair=False).verdict == "not met"
    assert race("work", "rival", 5.0, Cost(1.0, 1.0), Cost(4.0, 4.0), "").verdict == "not met"


def test_the_page_says_how_many_runs_and_of_which_state(tmp_path: Path) -> None:
    line = Line("work", "rival", "2×", "4×", True, Cost(1.0, 1.5, 3), Cost(4.0, 4.5, 3), "alike")
    limit = Line("work", "a limit", "≤ 2 s", "1 s", np.float64(1.0) < 2.0, Cost(1.0, 1.5, 3))
    record = Record((line, limit), 1.0, "Python 3", "0" * 20, "2020-01-01")
    save("group", record, tmp_path)
    assert load("group", tmp_path) == record and load("another", tmp_path) is None
    text = page({"Heading": {"group": record}})
    assert f"| group | 2020-01-01 | {'0' * 20} | 1.0 |" in text
    assert "| work | rival | 2× | 4× | – | met | 1 (1.5) | 4 (4.5) | 3 |" in text
    assert "- work, rival: alike." in text
    columns = {row.count("|") for row in text.split("## When")[0].splitlines() if row.startswith("|")}
    assert len(columns) == 1


def test_the_run_before_stands_beside_the_last_one_of_the_same_code(tmp_path: Path) -> None:
    def run(result: str, numerics: str) -> str:
        line = Line("work", "rival", "2×", result, True)
        save("group", Record((line,), 1.0, "Python 3", numerics, "2020-01-01"), tmp_path)
        record = load("group", tmp_path)
        assert record is not None
        return page({"Heading": {"group": record}})

    assert "| 4× | – | met |" in run("4×", "a")
    assert "| 3× | 4× | met |" in run("3×", "a")
    assert "| 5× | 3× | met |" in run("5×", "a")
    assert "| 6× | – | met |" in run("6×", "b")


def test_the_clock_adds_iterations_and_leaves_out_what_lies_between() -> None:
    clock = IterationClock()
    clock.start()
    np.linalg.norm(np.random.default_rng(0).normal(size=(400, 400)), 2)
    clock.tick(1, 0.0)
    spent = clock.cpu
    np.linalg.norm(np.random.default_rng(0).normal(size=(400, 400)), 2)
    clock.start()
    clock.tick(2, 0.0)
    assert 0.0 < spent <= clock.cpu < 1.5 * spent


def test_excess_of_a_half_sphere_on_every_scale() -> None:
    """r = z on the sphere: the least energy is that of a cap, the empty field has 0 and the full one too."""
    operator = fem(icosphere(3).mesh)
    problem = convex_chan_vese(operator.mass, 8.0 * icosphere(3).mesh.vertices[:, 2])
    recorded = Recorded(partial(primal_dual, tolerance=1e-4))
    solution = recorded(problem, operator)
    assert recorded.problem is problem and solution.lower_bound is not None
    excess = Excess(problem, operator)
    assert 0.0 <= excess.of(solution.values) <= 2e-4
    nothing = np.zeros(operator.vertex_count)
    total = float(operator.mass @ np.abs(problem.slope))
    assert excess.of(nothing) == pytest.approx(-solution.lower_bound / total, rel=1e-2)
    words = excess.scales(nothing)
    assert "1.0e+00 of the least energy" in words and "1.0e+00 of the spread" in words


def test_the_peak_memory_of_a_command_is_its_own(tmp_path: Path) -> None:
    held = np.ones(80_000_000)
    assert _command(["--version"], str(tmp_path))[1] < 0.5 * held.nbytes


@pytest.mark.slow
@pytest.mark.parametrize("group", GROUPS)
def test_every_group_runs_at_small_sizes(group: str) -> None:
    """In a process of its own, which sets its threads before it imports; rivals that are not installed are said so."""
    command = [sys.executable, "-m", "audits.benchmarks", "--quick", group]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[-2000:]
    assert "asked" in run.stdout
    assert "energy excess" not in run.stdout
