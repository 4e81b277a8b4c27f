"""A run ends with one screen: what is wrong first, whole numbers, no constant column, and where the rest stands."""

from __future__ import annotations

import io
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from rich.console import Console

from surfexp.commands.last_screen import print_last_screen
from surfexp.commands.request import dashboard_line
from surfexp.commands.verdict_lines import verdicts_of
from surfexp.commands.views import print_tables
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.records.written_numbers import format_number
from surfexp.report.verdict import Verdict

TAIL = [
    "report     results/a/report.html",
    "all rows   results/a/metrics.csv, surfexp table a",
    "dashboard  surfexp ui",
]
NUMBERS = (9.4512e-5, -45437.2, 3607872.0, 0.9891, 1.5e8, 8417.0)


def table(
    rows: int, metrics: int, title: str = "A race of everything against everything else that there is"
) -> Comparison:
    made = []
    for k in range(rows):
        leaf = Leaf(f"key{k}", "configuration", {"target": "solver"})
        values = {f"some metric {m}": NUMBERS[(k + m) % len(NUMBERS)] * (1 + k) for m in range(metrics)}
        parameters = {"solver.name": ("primal_dual", "split_bregman")[k % 2], "model.weight": k, "surface.name": "cup"}
        made.append(Row(leaf, parameters, values | {"always": 2.5}, 1.0, ["A long note of one row."] if k == 0 else []))
    return Comparison(title, "", made, [])


def claims(count: int) -> list[Verdict]:
    claim = {
        "quantity": {"all": "some metric 0"},
        "because": "why",
        "between": [0.0, 1e-9],
        "claim": "it is small " * 9,
    }
    plan = cast(Plan, SimpleNamespace(settings=SimpleNamespace(claims=count * [claim])))
    return verdicts_of(plan, table(2, 2).rows)


def printed(groups: list[Comparison], width: int, height: int, wrong: int = 0) -> list[str]:
    sink = io.StringIO()
    console = Console(file=sink, width=width, height=height, force_terminal=True, color_system=None)
    warnings = [
        f"A race: primal_dual, {k}: did not converge " + "because of what it was given " * 3 for k in range(wrong)
    ]
    print_last_screen(groups, claims(wrong), warnings, TAIL, console)
    return sink.getvalue().splitlines()


@pytest.mark.parametrize("width", [80, 120])
@pytest.mark.parametrize("wrong", [0, 1, 9])
@pytest.mark.parametrize(("tables", "rows"), [(1, 3), (2, 12), (9, 4), (1, 300)])
def test_the_end_is_one_screen_and_no_number_is_cut(width: int, wrong: int, tables: int, rows: int) -> None:
    groups = [table(rows, 9) for _ in range(tables)]
    lines = printed(groups, width, 24, wrong)
    assert len(lines) <= 22 and max(map(len, lines)) <= width and lines[-3:] == TAIL
    shown = {format_number(row.metrics["some metric 0"]) for row in groups[0].rows}
    words = {word for line in lines for word in line.split("  ")}
    if any(line.startswith("primal_dual") for line in lines):
        assert shown & {word.strip() for word in words}
    numbers = {format_number(value) for row in groups[0].rows for value in row.metrics.values()}
    cells = [
        cell.strip() for line in lines if line.startswith(("primal", "split")) for cell in line.split("  ") if cell
    ]
    assert {*cells} <= numbers | {"primal_dual", "split_bregman", ""} | {str(k) for k in range(rows)}
    if wrong:
        assert "does not hold" in lines[0] and any("did not converge" in line for line in lines)


def test_a_taller_terminal_has_every_row_and_a_wider_one_every_number() -> None:
    lines = printed([table(12, 9)], 200, 60)
    assert sum(line.startswith(("primal", "split")) for line in lines) == 12
    assert not any("of 12 rows" in line or "numbers)" in line for line in lines)


def test_what_is_left_out_is_said_and_a_constant_once() -> None:
    lines = printed([table(30, 9)], 80, 24)
    assert "of 30 rows" in lines[0] or "of 30 rows" in lines[1]
    assert sum("always 2.5" in line for line in lines) == 1 and not any("cup" in line for line in lines)
    assert any("7 tables more" in line for line in printed([table(9, 9) for _ in range(9)], 80, 24))


def test_lines_break_at_spaces_and_hang() -> None:
    lines = printed([table(3, 2)], 80, 24, 1)
    claim = next(k for k, line in enumerate(lines) if line.startswith("does not hold"))
    assert lines[claim + 1].startswith("  ") and " ".join(line.strip() for line in lines).count("it is small") == 9


def test_an_output_that_is_no_terminal_carries_the_notes() -> None:
    sink = io.StringIO()
    print_tables([table(3, 2)], Console(file=sink, width=2000))
    text = sink.getvalue()
    assert "primal_dual [1]" in text and "[1] A long note of one row." in text and text.count("[1]") == 2


def test_a_failed_row_says_so_in_its_line() -> None:
    group: Any = table(3, 2)
    group.rows[1].failure = "no mesh"
    lines = printed([group], 80, 24)
    assert next(line for line in lines if line.endswith("failed")).startswith("split_bregman")
    assert not np.any([line.endswith("converged") for line in lines])


def test_a_dashboard_is_named_where_there_is_one(tmp_path: Path) -> None:
    assert dashboard_line(tmp_path, "") == "dashboard  not written"
    (tmp_path / "mlflow.db").touch()
    assert dashboard_line(tmp_path, " --results here") == "dashboard  surfexp ui --results here"


def test_a_metric_that_is_no_number_is_named_with_its_rows() -> None:
    group = table(3, 2)
    assert not any("NaN" in line for line in printed([group], 100, 40))
    group.rows[1].metrics["some metric 0"] = math.nan
    said = "some metric 0 is NaN in 1 of 3 rows: its method gave no number there"
    assert printed([group], 100, 40).count(said) == 1
    sink = io.StringIO()
    print_tables([group], Console(file=sink, width=200))
    assert sink.getvalue().splitlines().count(said) == 1


def test_seconds_that_were_asked_for_are_shown() -> None:
    leaf = Leaf("key", "configuration", {"target": "solver"})
    rows = [Row(leaf, {"solver.name": name}, {"gap": 1.0 + k}, 0.25 + k) for k, name in enumerate("ab")]
    text = "\n".join(printed([Comparison("Clocks", "", rows, ["seconds", "gap"])], 100, 40))
    assert "seconds" in text and "0.25" in text and "1.25" in text
