"""Rows that differ by seeds alone become mean and deviation, in the page, the terminal and LaTeX."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from audits.benchmarks.synthetic_results import fill, plan_of
from surfexp.commands.views import print_tables
from surfexp.contract.metric import Metric
from surfexp.lab.plan.plan import Leaf
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.report.latex import latex_table
from surfexp.report.page import write_report
from surfexp.report.repeats import mean_and_deviation, repeats_of

METRICS = {"rmse": Metric("error", "mm", "lower"), "psnr": Metric("", "dB", "higher")}
LEAF = Leaf("key", "", {"target": "solver"})


def row(seed: int, operator: str, rmse: float, **more: float) -> Row:
    metrics = {"rmse": rmse, "converged": 1.0, **more}
    return Row(LEAF, {"image.seed": seed, "operator.name": operator}, metrics, 1.0)


def group(rows: list[Row]) -> Comparison:
    return Comparison("Noise", "", rows, [], METRICS)


def test_mean_and_deviation_are_those_of_numpy_over_what_was_solved() -> None:
    values = np.random.default_rng(0).normal(5.0, 1.0, (2, 7))
    rows = [row(k, name, float(values[i, k])) for k in range(7) for i, name in enumerate(("fem", "libigl"))]
    rows[0].failure, rows[3].metrics["converged"] = "MemoryError", 0.0
    found = repeats_of(group(rows))
    assert found is not None and (found.seeds, found.columns) == (["image.seed"], ["operator.name"])
    for line, kept in zip(found.rows, (values[0, 1:], np.delete(values[1], 1)), strict=True):
        assert (line.count, line.solved) == (7, 6)
        assert line.metrics["rmse"] == pytest.approx((kept.mean(), kept.std(ddof=1)))


def test_what_is_not_repeated_three_times_has_no_such_table() -> None:
    assert repeats_of(group([row(k, "fem", 1.0 + k) for k in range(2)])) is None
    assert repeats_of(group([row(0, name, 1.0) for name in ("fem", "libigl", "scaled")])) is None
    uneven = [row(k, "fem", 1.0 + k) for k in range(5)] + [row(0, "libigl", 1.0)]
    assert repeats_of(group(uneven)) is None


def test_a_metric_that_nobody_has_is_a_dash() -> None:
    rows = [
        row(k, name, 1.0 + k, **({"psnr": 20.0} if name == "fem" else {})) for k in range(3) for name in ("fem", "x")
    ]
    found = repeats_of(group(rows))
    assert found is not None
    assert ["psnr" in line.metrics for line in found.rows] == [True, False]
    assert found.rows[0].metrics["psnr"] == (20.0, 0.0)


def test_a_mean_over_fewer_rows_says_over_how_many() -> None:
    rows = [row(k, "fem", 1.0 + k, psnr=math.nan if k < 2 else 20.0 + k) for k in range(5)]
    found = repeats_of(group(rows))
    assert found is not None and found.rows[0].solved == 5
    assert found.rows[0].shown("psnr") == "23.0 ± 1.0 (of 3)" and found.rows[0].shown("rmse") == "3.0 ± 1.6"
    assert r"$23.0 \pm 1.0$ (of 3)" in latex_table(group(rows), "t", "surfexp run")


@pytest.mark.parametrize(("ends", "shown"), [((math.inf, 1.0), "∞"), ((math.inf, -math.inf), "–")])
def test_infinite_values_have_no_deviation(ends: tuple[float, float], shown: str) -> None:
    rows = [row(k, "fem", 1.0 + k, psnr=value) for k, value in enumerate((*ends, 20.0))]
    found = repeats_of(group(rows))
    assert found is not None and found.rows[0].shown("psnr") == shown


@given(st.floats(-1e12, 1e12, allow_subnormal=False), st.floats(1e-12, 1e12, allow_subnormal=False, exclude_min=True))
def test_the_shown_mean_is_within_a_twentieth_of_the_deviation_or_four_digits(mean: float, deviation: float) -> None:
    shown = mean_and_deviation(mean, deviation).replace("\u202f", "").replace("−", "-")
    first, second = (float(text) for text in shown.split(" ± "))
    assert abs(first - mean) <= max(
        0.051 * deviation, 6e-4 * abs(mean), 6e-2 * abs(mean) * (abs(mean) < 1e-3 or abs(mean) >= 1e6)
    )
    assert abs(second - deviation) <= 0.051 * deviation


def test_without_a_deviation_there_is_the_number() -> None:
    assert mean_and_deviation(1.5, math.nan) == "1.5" and mean_and_deviation(2.0, 0.0) == "2 ± 0"


def test_page_terminal_and_latex_say_the_same(tmp_path: Path) -> None:
    race = {
        "experiment": "race",
        "columns": ["rmse"],
        "surface": "cup",
        "image": {"name": "picture", "noise": 40.0},
        "solver": "primal_dual",
        "model": "rof",
        "grid": {"image.seed": [0, 1, 2], "operator": ["fem", "libigl"]},
    }
    plan = plan_of(race, tmp_path)
    fill(plan, tmp_path)
    page = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "Mean ± standard deviation over image seed, n = 3" in page and "6 rows" in page
    shown = re.findall(r'<td class="number" data-name="rmse"[^>]*>([^<]* ± [^<]*)</td>', page)
    assert len(shown) == 2


def test_the_terminal_and_latex_have_a_line_for_each_method() -> None:
    rows = [row(k, name, 1.0 + k / 10) for k in range(3) for name in ("fem", "libigl")]
    rows[0].failure = "MemoryError"
    console = Console(width=120, record=True, file=None)
    with console.capture() as captured:
        print_tables([group(rows)], console)
    assert "mean ± deviation over image seed" in captured.get()
    assert "1.150 ± 0.071" in captured.get() and "2 of 3" in captured.get() and "1.10 ± 0.10" in captured.get()
    text = latex_table(group(rows), "noise", "surfexp run")
    assert r"fem & $1.150 \pm 0.071$ & $2$ of $3$ \\" in text and r"libigl & $1.10 \pm 0.10$ & $3$ \\" in text
    assert r"Mean $\pm$ standard deviation over image seed" in text and "$n$" in text
