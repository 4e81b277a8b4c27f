"""The report page shows texts as they are written, and of a long table an excerpt; its work grows with the rows."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.synthetic_results import fill, plan_of, sweep
from surfexp.report import page
from surfexp.report.page import prose, write_report
from surfexp.report.table import HIGHER_IS_BETTER, LOWER_IS_BETTER, Comparison, Row, number_notes, rows_of
from surfexp.report.verdict import _quantity
from surfexp.workflow.plan import Leaf


def test_text_is_escaped_and_backticks_are_code() -> None:
    shown = prose("run `collect --group '(?P<class>a|b)'` where x < y & z")
    assert shown == ("run <code>collect --group &#39;(?P&lt;class&gt;a|b)&#39;</code> where x &lt; y &amp; z")
    assert prose("one ` alone") == "one ` alone"


def rows_by_chance(count: int, seed: int) -> list[Row]:
    random = np.random.default_rng(seed)
    leaf = Leaf("key", "configuration", {"target": "solver"})
    rows = []
    for number in range(count):
        metrics = {"rmse": float(random.integers(3)), "psnr": random.choice([1.0, float("nan")]), "area": 1.0}
        metrics |= {"converged": float(random.integers(2))} | ({"dice": 0.5} if number % 3 else {})
        rows.append(Row(leaf, {"solver.name": "rof", "solver.seed": number}, metrics, 1.0, [f"note {number % 2}"]))
    return rows


def is_best_among_all(group: Comparison, name: str, row: Row) -> bool:
    """The definition, which looks at every row for each cell."""
    values = [other.metrics[name] for other in group.rows if name in other.metrics and not other.limited]
    values = [value for value in values if value == value]
    if name not in row.metrics or row.limited or len(set(values)) < 2:
        return False
    if name.startswith(HIGHER_IS_BETTER):
        return row.metrics[name] == max(values)
    return name.startswith(LOWER_IS_BETTER) and row.metrics[name] == min(values)


@pytest.mark.parametrize("seed", range(20))
def test_the_best_of_a_column_is_found_once(seed: int) -> None:
    group = Comparison("", "", rows_by_chance(7, seed), [])
    for row in group.rows:
        for name in group.metric_names:
            assert group.is_best(row, name) == is_best_among_all(group, name, row)
    shown = group.excerpt(2)
    assert shown[:2] == group.rows[:2] and len(shown) <= 2 + len(group.best)
    assert set(group.best) <= {name for row in shown for name in group.best if group.is_best(row, name)}
    assert number_notes(group.rows) == {"note 0": 1, "note 1": 2}


def test_a_long_table_is_an_excerpt_that_says_so_and_nothing_is_lost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = plan_of(sweep(24), tmp_path)
    fill(plan, tmp_path)
    whole = (write_report(plan, tmp_path) / "report.html").read_text()
    assert whole.count("<tr>") == 25 and "rows are shown" not in whole
    monkeypatch.setattr(page, "ROWS_SHOWN", 5)
    folder = write_report(plan, tmp_path)
    short = (folder / "report.html").read_text()
    best = min(row.metrics["rmse"] for row in rows_of(plan, tmp_path))
    assert "of 24 rows are shown" in short and short.count("<tr>") in (6, 7)
    assert short.count('class="number best"') == 1 and f"{best:.4g}" in short
    with (folder / "metrics.csv").open() as file:
        assert [row["leaf"] for row in csv.DictReader(file)] == [leaf.key for leaf in plan.leaves]


def test_work_grows_with_the_rows_and_each_file_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    counts: dict[str, int] = {}

    def count(name: str, original: Any) -> Any:
        def counted(*given: Any, **named: Any) -> Any:
            counts[name] = counts.get(name, 0) + 1
            return original(*given, **named)

        return counted

    monkeypatch.setattr(Row, "limited", property(count("limited", Row.limited.fget)))  # type: ignore[attr-defined]
    monkeypatch.setattr(Comparison, "_cells", count("columns", Comparison._cells))
    for reader in ("read_bytes", "read_text"):
        monkeypatch.setattr(Path, reader, count(reader, getattr(Path, reader)))
    seen = {}
    for leaves in (30, 60):
        plan = plan_of(sweep(leaves), tmp_path / str(leaves))
        fill(plan, tmp_path / str(leaves))
        write_report(plan, tmp_path / str(leaves))  # what is read once for all: the template, package versions
        counts.clear()
        write_report(plan, tmp_path / str(leaves))
        seen[leaves] = dict(counts)
        assert counts["read_bytes"] <= leaves + 2 and counts["read_text"] <= leaves + 2
    assert seen[60]["limited"] <= 2 * seen[30]["limited"] and seen[30]["columns"] == seen[60]["columns"]


def test_ratios_lie_between_those_of_the_extremes() -> None:
    from surfexp.report.claim import Claim

    claim = Claim(claim="c", quantity="ratio", metric="gap", over={"a": 1}, between=(0, 1), because="b")
    random = np.random.default_rng(0)
    for _ in range(200):
        values, divisors = (list(random.normal(random.normal(), 1.0, random.integers(1, 6))) for _ in range(2))
        ratios = [above / below for above in values for below in divisors]
        assert _quantity(claim, values, divisors)[1:] == (min(ratios), max(ratios))
