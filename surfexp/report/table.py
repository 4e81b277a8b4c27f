"""Tidy tables of a plan: a row a leaf, a column a parameter or metric, grouped into comparisons."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from surfexp.io.csv_cells import cells
from surfexp.workflow.outcome import outcome
from surfexp.workflow.plan import Leaf, Plan

LOWER_IS_BETTER = ("rmse", "relative_gap", "error_bound", "energy", "iterations", "perimeter", "energy_excess")
HIGHER_IS_BETTER = ("dice", "accuracy", "psnr")


@dataclass
class Row:
    """One leaf: its parameters, metrics, notes and whether its certificate was reached.

    `seconds` is measured, not a part of the result: None where the event of the stage was lost.
    """

    leaf: Leaf
    parameters: dict[str, Any]
    metrics: dict[str, float]
    seconds: float | None
    notes: list[str] = field(default_factory=list)
    failure: str = ""

    @property
    def limited(self) -> bool:
        """Whether it did not converge: it ended before its tolerance, or the means of its regions still moved."""
        return self.metrics.get("converged", 1.0) == 0.0


@dataclass
class Comparison:
    """The rows of one table: the columns are the parameters that differ and the metrics that were asked for.

    The columns are found once, when they are first asked for: the rows have to be complete then.
    """

    title: str
    caption: str
    rows: list[Row]
    columns: list[str]

    @cached_property
    def varying(self) -> list[str]:
        """The plugin names and options that tell rows apart, each once; of one row its own plugin.

        An option counts only between rows of one plugin. One that several inputs share, alike in every row, is shown
        at the first of them.
        """
        names = dict.fromkeys(name for row in self.rows for name in row.parameters)
        if len(self.rows) == 1:
            return [f"{self.rows[0].leaf.settings['target']}.name"]
        shown = [name for name in names if self._differs(name)]
        shown.sort(key=lambda name: not name.endswith(".name"))
        cells = {name: (name.rpartition(".")[2], self._cells(name)) for name in shown}
        alike = {cells[name]: name for name in reversed(shown)}
        return [name for name in shown if alike[cells[name]] == name]

    def _cells(self, name: str) -> tuple[str, ...]:
        return tuple(str(row.parameters.get(name, "–")) for row in self.rows)

    def _differs(self, name: str) -> bool:
        stage = name.rpartition(".")[0]
        found: dict[str, set[str]] = {}
        for row in self.rows:
            method = "" if name.endswith(".name") else str(row.parameters.get(f"{stage}.name"))
            if name in row.parameters or not method:
                found.setdefault(method, set()).add(str(row.parameters.get(name, "–")))
        return any(len(values) > 1 for values in found.values())

    @cached_property
    def metric_names(self) -> list[str]:
        """Metrics shown: those asked for that exist, or all; `converged` is said by the row itself."""
        names = dict.fromkeys(name for row in self.rows for name in row.metrics if name != "converged")
        return [name for name in self.columns if name in names] if self.columns else list(names)

    @cached_property
    def best(self) -> dict[str, float]:
        """The best value of each metric whose good direction is known and which tells converged rows apart."""
        found = {}
        for name in self.metric_names:
            values = {row.metrics[name] for row in self.rows if name in row.metrics and not row.limited}
            values = {value for value in values if not math.isnan(value)}
            if len(values) > 1 and name.startswith(HIGHER_IS_BETTER + LOWER_IS_BETTER):
                found[name] = max(values) if name.startswith(HIGHER_IS_BETTER) else min(values)
        return found

    def is_best(self, row: Row, name: str) -> bool:
        """Whether a row holds the best value of a metric."""
        return not row.limited and name in self.best and row.metrics.get(name) == self.best[name]

    def excerpt(self, limit: int) -> list[Row]:
        """The first rows, and of the others the first with the best value of each metric; all where they are few."""
        if len(self.rows) <= limit:
            return self.rows
        first = {name: next(row for row in self.rows if self.is_best(row, name)) for name in self.best}
        ahead = {id(row) for row in (*self.rows[:limit], *first.values())}
        return [row for row in self.rows if id(row) in ahead]


def rows_of(plan: Plan, results: Path) -> list[Row]:
    """Read what is known of every leaf: numbers from its result, seconds and failure from its event."""
    rows = []
    for leaf in plan.leaves:
        found = outcome(results, plan.nodes[leaf.key])
        parameters = {key: value for key, value in plan.parameters(leaf).items() if value is not None}
        rows.append(Row(leaf, parameters, found.metrics, found.seconds, list(found.notes), found.failure))
    return rows


def comparisons(rows: list[Row]) -> list[Comparison]:
    """Group rows by the comparison that their variant names, in order of appearance."""
    groups: dict[str, Comparison] = {}
    for row in rows:
        settings = row.leaf.settings
        title = settings["comparison"] or settings["title"] or settings["experiment"]
        group = groups.setdefault(title, Comparison(title, settings["caption"], [], []))
        group.rows.append(row)
        group.columns += [name for name in settings["columns"] if name not in group.columns]
    return list(groups.values())


def number_notes(rows: Sequence[Row]) -> dict[str, int]:
    """The notes of rows, each once, by the number that stands for it in a table."""
    notes = dict.fromkeys(note for row in rows for note in row.notes)
    return {note: number for number, note in enumerate(notes, 1)}


def to_csv(rows: list[Row]) -> str:
    """The tidy table as text: comparison, parameters, metrics, failure."""
    parameters = list(dict.fromkeys(name for row in rows for name in row.parameters))
    metrics = list(dict.fromkeys(name for row in rows for name in row.metrics))
    sink = io.StringIO()
    writer = csv.writer(sink, lineterminator="\n")
    writer.writerow(cells(["comparison", "leaf", *parameters, *metrics, "seconds", "failure"]))
    for row in rows:
        values = [row.parameters.get(name, "") for name in parameters]
        numbers = [repr(row.metrics[name]) if name in row.metrics else "" for name in metrics]
        comparison = row.leaf.settings["comparison"]
        seconds = "" if row.seconds is None else f"{row.seconds:.3f}"
        writer.writerow(cells([comparison, row.leaf.key, *values, *numbers, seconds, row.failure]))
    return sink.getvalue()


def format_number(value: float | None) -> str:
    """Four significant digits, powers of ten only where they help, a dash for nothing."""
    if value is None or value != value:
        return "–"
    if value == int(value) and abs(value) < 1e7:
        return f"{int(value):,}".replace(",", "\u202f")
    if 1e-3 <= abs(value) < 1e6:
        return f"{value:.4g}" if abs(value) < 1e4 else f"{value:,.0f}".replace(",", "\u202f")
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def short_name(parameter: str) -> str:
    """Heading of a parameter's column: the stage for a plugin's name, the option otherwise."""
    stage, _, option = parameter.rpartition(".")
    return (
        stage
        if option == "name"
        else parameter
        if "[" in parameter
        else f"{stage.split('.')[-1]} {option}".replace("_", " ")
    )
