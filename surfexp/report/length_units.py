"""The unit of length of a table's surfaces, in the heads of its columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from surfexp.contract.metric import Metric
from surfexp.lab.errors import DamagedResult
from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import store
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row

OPEN = "unit of length"


def name_lengths(group: Comparison, plan: Plan, results: Path) -> None:
    """Give metrics in units of length the unit in which all surfaces of a table are, where they have one."""
    shown = {name: group.meaning(name) for name in group.metric_names}
    if any(OPEN in metric.unit for metric in shown.values()) and (unit := _unit(plan, results, group.rows)):
        group.metrics = {**group.metrics, **in_unit(shown, unit)}


def in_unit(metrics: Mapping[str, Metric], unit: str) -> dict[str, Metric]:
    """Return metrics with a unit of length put in.

    Examples
    --------
    >>> in_unit({"area": Metric("area", "unit of length squared")}, "mm")["area"].unit
    'mm²'
    """
    return {
        name: replace(metric, unit=metric.unit.replace(f"{OPEN} squared", f"{unit}²").replace(OPEN, unit))
        for name, metric in metrics.items()
    }


def _unit(plan: Plan, results: Path, rows: Sequence[Row]) -> str:
    keys = {key for row in rows for key in row.data if plan.nodes[key].kind == "surface"}
    try:
        units = {str(store.load(results, "surface", key).unit) for key in sorted(keys)}
    except (DamagedResult, OSError):
        return ""
    return units.pop() if len(units) == 1 else ""
