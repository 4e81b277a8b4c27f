"""Tables in a terminal of any width: no number is cut, every row is there."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from surfexp.commands.views import print_tables
from surfexp.lab.plan.plan import Leaf
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.records.written_numbers import format_number

NUMBERS = [9.4512e-5, -611.7, 3607872.0, 0.9891, 566211.0, 1.5e8, 20000.0]


def comparison(metrics: int, failure: str = "") -> Comparison:
    leaf = Leaf("key", "configuration", {"target": "solver"})
    rows = []
    for number, solver in enumerate(("primal_dual_of_everything", "split_bregman", "level_set")):
        values = {f"some_metric_{k}": NUMBERS[(k + number) % len(NUMBERS)] * (1.0 + number) for k in range(metrics)}
        parameters = {"solver.name": solver, "operator.name": "vertex_averaged", "solver.tolerance": 10.0**-number}
        rows.append(Row(leaf, parameters, values, 1.0, failure=failure if number == 1 else ""))
    return Comparison("A race [bold]of[/bold] three", "", rows, [])


def printed(group: Comparison, width: int, limit: int | None = None) -> str:
    sink = io.StringIO()
    print_tables([group], Console(file=sink, width=width, highlight=False), limit)
    return sink.getvalue()


@pytest.mark.parametrize("width", [30, 60, 80, 100, 200])
@pytest.mark.parametrize("metrics", [1, 3, 9])
def test_no_number_is_cut_at_any_width(width: int, metrics: int) -> None:
    group = comparison(metrics)
    text = printed(group, width)
    words = text.replace("│", " ").split()
    for row in group.rows:
        for value in row.metrics.values():
            assert set(format_number(value).split("\u202f")) <= {
                part for word in words for part in word.split("\u202f")
            }
    assert "…" not in text and "A race [bold]of[/bold] three" in text


def test_wide_terminals_have_a_table_and_narrow_ones_blocks() -> None:
    assert "│" in printed(comparison(3), 120) and "│" not in printed(comparison(9), 60)
    block = printed(comparison(9), 60)
    assert block.count("\n\n") == 3 and block.count("  some metric 8 ") == 3
    assert max(map(len, block.splitlines())) <= 60


@pytest.mark.parametrize("width", [60, 200])
def test_a_failed_row_says_so(width: int) -> None:
    assert printed(comparison(9, "division by zero"), width).count("failed") == 1


def test_names_with_brackets_are_shown_as_they_are() -> None:
    leaf = Leaf("key", "configuration", {"target": "solver"})
    rows = [
        Row(leaf, {"solver.name": "[/b]", "solver.x": k}, {"remoteness [/b]": 1.0, "gap [mm]": 2.0}, 1.0)
        for k in (1, 2)
    ]
    for width in (30, 200):
        text = printed(Comparison("", "", rows, []), width)
        assert "[/b]" in text and "[mm]" in text


def timed(timing: bool) -> Comparison:
    leaf = Leaf("key", "configuration", {"target": "solver", "timing": timing})
    rows = [
        Row(leaf, {"solver.name": name}, {"gap": 1.0, "rmse": 2.0}, seconds)
        for name, seconds in (("newton", 0.25), ("primal_dual", 4.5), ("level_set", None))
    ]
    return Comparison("Clocks", "", rows, ["rmse", "seconds", "gap"])


def test_seconds_stand_where_they_were_asked_for() -> None:
    head, *rows = [
        [cell.strip() for cell in line.strip("┃│").replace("┃", "│").split("│")]
        for line in printed(timed(False), 100).splitlines()
        if line.startswith(("┃", "│"))
    ]
    assert head == ["solver", "rmse", "seconds", "gap"]
    assert [row[2] for row in rows] == ["0.25", "4.5", "–"]


def test_seconds_have_a_best_only_in_benchmark_mode() -> None:
    for timing, best in ((False, []), (True, [True, False, False])):
        group = timed(timing)
        assert group.meaning("seconds").unit == "s"
        assert [group.is_best(row, "seconds") for row in group.rows if timing] == best
        assert timing or not any(group.is_best(row, "seconds") for row in group.rows)
