"""The dashboard opens with the columns that differ and the numbers of the tables, sorted by what is sought."""

from __future__ import annotations

import json
from typing import Any

from surfexp.contract.metric import Metric
from surfexp.lab.plan.plan import Leaf
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.report.dashboard_view import dashboard_view

METRICS = {"rmse": Metric("", "mm", "lower"), "psnr": Metric("", "dB", "higher"), "area": Metric("")}


def view(columns: list[str], objective: str | None = None) -> dict[str, Any]:
    leaf = Leaf("key", "configuration", {"target": "solver"})
    numbers = {"rmse": 1.0, "psnr": 2.0, "area": 3.0}
    rows = [Row(leaf, {"solver.name": name, "model.mu": 1.0}, numbers, 1.0) for name in ("newton", "primal_dual")]
    found: dict[str, Any] = json.loads(dashboard_view([Comparison("", "", rows, columns, METRICS)], objective))
    return found


def test_columns_are_the_numbers_asked_for_and_the_options_that_differ() -> None:
    shown = view(["psnr", "seconds", "rmse"])
    assert shown["selectedColumns"] == ["metrics.`psnr`", "metrics.`rmse`", "params.`solver.name`"]
    assert [chart.get("metricKey") for chart in shown["compareRunCharts"]] == [None, "psnr", "rmse"]
    sections = {section["uuid"] for section in shown["compareRunSections"]}
    assert {chart["metricSectionId"] for chart in shown["compareRunCharts"]} == sections


def test_rows_are_sorted_by_the_objective_or_the_first_number_with_a_good_direction() -> None:
    for columns, objective, sought in (
        (["area", "psnr", "rmse"], None, ("metrics.`psnr`", False)),
        (["area", "rmse", "psnr"], None, ("metrics.`rmse`", True)),
        (["area"], "psnr", ("metrics.`psnr`", True)),  # an objective is minimised
        (["area"], None, ("attributes.`Start Time`", True)),
    ):
        shown = view(columns, objective)
        assert (shown["orderByKey"], shown["orderByAsc"]) == sought
        assert objective is None or f"metrics.`{objective}`" in shown["selectedColumns"]
