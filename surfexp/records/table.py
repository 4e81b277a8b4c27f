"""Tidy tables of a plan: a row a leaf, a column a parameter or metric."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from operator import itemgetter
from pathlib import Path
from typing import Any

from surfexp.io.csv_cells import cells
from surfexp.lab.plan.outcome import NOT_COMPUTED, outcome
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.records.failures import cause
from surfexp.records.written_numbers import as_in_tables

# what tables call the processor time of a stage
SECONDS = "seconds"
# the kinds whose results are given: rows on other data have no common best
DATA = ("surface", "image")
# the kinds whose rows are answers to one question where their data agree; a statistic may ask another in each row, unless
# it measures a solver's result
ANSWERS = ("solver", "distance", "distance_matrix", "embedding", "classifier")


@dataclass
class Row:
    """One leaf: its parameters, metrics, notes and whether its certificate was reached.

    `seconds` is measured on `machine`, not a part of the result: None where the event of the stage was lost. `data` are the keys of
    the surfaces and images that it starts from. `measured` says that the leaf is a measure of one solver's result.
    """

    leaf: Leaf
    parameters: dict[str, Any]
    metrics: dict[str, float]
    seconds: float | None
    notes: list[str] = field(default_factory=list)
    failure: str = ""
    data: frozenset[str] = frozenset()
    measured: bool = False
    machine: str = ""

    def number(self, name: str) -> float | None:
        """A metric of the row, or its seconds; None where it has none."""
        return self.seconds if name == SECONDS else self.metrics.get(name)

    @property
    def answers(self) -> bool:
        """Whether it answers the same question as other rows on its data."""
        return self.measured or self.leaf.settings["target"] in ANSWERS

    @property
    def limited(self) -> bool:
        """Whether it did not converge: it ended before its tolerance, or the means of its regions still moved."""
        return self.metrics.get("converged", 1.0) == 0.0

    @property
    def state(self) -> str:
        """What stands beside a row that failed, was not computed or did not converge; empty beside others."""
        if self.failure:
            return self.failure if self.failure == NOT_COMPUTED else "failed"
        return "not converged" if self.limited else ""


def rows_of(plan: Plan, results: Path) -> list[Row]:
    """Read what is known of every leaf: numbers from its result, seconds and failure from its event.

    One that was not computed since a stage before it failed has the failure of that stage.
    """
    rows, known, causes = [], dict[str, frozenset[str]](), dict[str, str]()
    for leaf in plan.leaves:
        found = outcome(results, plan.nodes[leaf.key])
        parameters = {key: value for key, value in plan.parameters(leaf).items() if value is not None}
        data = _data(plan, leaf.key, known)
        node = plan.nodes[leaf.key]
        measured = node.kind == "statistic" and "solver" in node.inputs
        notes = [as_in_tables(note) for note in found.notes]
        failure = found.failure
        if failure == NOT_COMPUTED:
            failure = cause(plan, results, leaf.key, causes) or failure
        measurement = parameters, found.metrics, found.seconds, notes, failure
        rows.append(Row(leaf, *measurement, data, measured, found.machine))
    return rows


def _data(plan: Plan, key: str, known: dict[str, frozenset[str]]) -> frozenset[str]:
    """The surfaces and images nearest before a stage; `known` are those that were asked for before."""
    if key not in known:
        node = plan.nodes[key]
        before = (_data(plan, child, known) for child in node.children)
        known[key] = frozenset([key]) if node.kind in DATA else frozenset().union(*before)
    return known[key]


def in_tables(rows: Sequence[Row]) -> list[Row]:
    """The rows, and those that several tables ask for again at their place in each; their figures stand with the first."""
    again = [
        (place - 0.5, replace(row, leaf=Leaf(row.leaf.key, row.leaf.configuration, settings)))
        for row in rows
        for place, settings in row.leaf.also
    ]
    return [row for _, row in sorted([*enumerate(rows), *again], key=itemgetter(0))]


def number_notes(rows: Sequence[Row]) -> dict[str, int]:
    """The notes of rows, each once, by the number that stands for it in a table."""
    notes = dict.fromkeys(note for row in rows for note in row.notes)
    return {note: number for number, note in enumerate(notes, 1)}


def to_csv(rows: list[Row]) -> str:
    """The tidy table as text: comparison, parameters, metrics, failure."""
    rows = in_tables(rows)
    parameters = list(dict.fromkeys(name for row in rows for name in row.parameters))
    metrics = list(dict.fromkeys(name for row in rows for name in row.metrics))
    sink = io.StringIO()
    writer = csv.writer(sink, lineterminator="\n")
    writer.writerow(cells(["comparison", "leaf", *parameters, *metrics, "seconds", "failure"]))
    for row in rows:
        values = [row.parameters.get(name, "") for name in parameters]
        numbers = [repr(row.metrics[name]) if name in row.metrics else "" for name in metrics]
        comparison = row.leaf.settings["comparison"]
        seconds = "" if row.seconds is None else repr(round(row.seconds, 6))
        writer.writerow(cells([comparison, row.leaf.key, *values, *numbers, seconds, row.failure]))
    return sink.getvalue()
