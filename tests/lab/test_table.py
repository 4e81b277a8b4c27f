"""Tables: which columns tell rows apart, and what a row that stopped early says."""

from __future__ import annotations

from typing import Any

from surfexp.lab.plan.plan import Leaf
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row


def row(metrics: dict[str, float] | None = None, **parameters: Any) -> Row:
    named = {name.replace("__", "."): value for name, value in parameters.items()}
    return Row(Leaf("key", "configuration", {"target": "distance"}), named, metrics or {}, 0.0)


def test_an_option_that_inputs_share_is_one_column() -> None:
    rows = [
        row(
            distance__name="hausdorff",
            target__name="disk",
            target__scale=scale,
            operator__scale=scale,
            target__seed=seed,
        )
        for scale, seed in ((1.0, 0), (2.0, 0), (2.0, 1))
    ]
    assert Comparison("", "", rows, []).varying == ["target.scale", "target.seed"]
    rows[2].parameters["operator.scale"] = 3.0
    assert Comparison("", "", rows, []).varying == ["target.scale", "operator.scale", "target.seed"]


def test_a_single_row_shows_its_own_plugin() -> None:
    rows = [row(distance__name="hausdorff", surface__name="disk")]
    assert Comparison("", "", rows, []).varying == ["distance.name"]


def test_a_row_at_its_limit_says_so_and_the_flag_is_no_column() -> None:
    rows = [row({"converged": 0.0, "gap": 1.0}), row({"converged": 1.0, "gap": 0.1})]
    assert [item.limited for item in rows] == [True, False]
    assert Comparison("", "", rows, []).metric_names == ["gap"]
