"""Tidy tables of a plan: a row a leaf, a column a parameter or metric, grouped into comparisons."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from operator import itemgetter
from pathlib import Path
from typing import Any

from surfexp.contract.metric import Metric, find_metric
from surfexp.io.csv_cells import cells
from surfexp.lab.plan.outcome import NOT_COMPUTED, outcome
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.records.failures import cause

# numbers of a note that tables write with spaces between thousands
LONG = re.compile(r"(?<![\w./,-])-?(?:\d{5,6}(?:\.\d+)?|\d{4}\.\d+)(?!\.?\w)")
# what tables call the processor time of a stage
SECONDS = "seconds"
# the kinds whose results are given: rows on other data have no common best
DATA = ("surface", "image")
# rows with a best value that an excerpt has beyond the first ones
BEST_BEYOND = 50
# what depends on the model, on its operator and on where a solver stops: a best among rows of different ones means nothing
OF_ONE_PROBLEM = ("gap", "relative_gap", "lower_bound", "error_bound", "iterations", "evaluations", "updates")
# where a certified row stopped below its tolerance, or what chance would give: a smaller one is no better
NO_MERIT = ("gap", "lower_bound", "error_bound", "p_value")
# the kinds whose rows are answers to one question where their data agree; a statistic may ask another in each row, unless
# it measures a solver's result
ANSWERS = ("solver", "distance", "distance_matrix", "embedding", "classifier")


@dataclass
class Row:
    """One leaf: its parameters, metrics, notes and whether its certificate was reached.

    `seconds` is measured, not a part of the result: None where the event of the stage was lost. `data` are the keys of
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


@dataclass
class Comparison:
    """The rows of one table: the columns are the parameters that differ and the metrics that were asked for.

    The columns are found once, when they are first asked for: the rows have to be complete then. `metrics` are the
    declarations by which metrics have a unit and a good direction; without them there is no best.
    """

    title: str
    caption: str
    rows: list[Row]
    columns: list[str]
    metrics: Mapping[str, Metric] = field(default_factory=dict)

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
        """Metrics shown: those asked for that exist, seconds among them, or all; `converged` is said by the row itself."""
        names = dict.fromkeys(name for row in self.rows for name in row.metrics if name != "converged")
        if not self.columns:
            return list(names)
        measured = any(row.seconds is not None for row in self.rows)
        return [name for name in self.columns if name in names or (name == SECONDS and measured)]

    def meaning(self, name: str) -> Metric:
        """The declaration of a metric; an empty one where there is none.

        Seconds have a good direction only in benchmark mode, where stages run one at a time.
        """
        if name == SECONDS:
            timed = all(row.leaf.settings.get("timing") for row in self.rows)
            return Metric("processor seconds of the stage, without compilation", "s", "lower" if timed else "")
        return find_metric(name, self.metrics) or Metric("")

    @cached_property
    def best(self) -> dict[tuple[str, frozenset[str]], float]:
        """The best value of each metric in which being better means something, by data, of rows that converged.

        There is none where all rows show the same number.
        """
        rows = [row for row in self.rows if self._may_be_best(row)]
        found = dict[tuple[str, frozenset[str]], float]()
        for name in self.metric_names:
            better, values = self.meaning(name).better, dict[frozenset[str], set[float]]()
            if name.endswith(NO_MERIT) or (name in OF_ONE_PROBLEM and self._several_problems):
                continue
            for row in rows if better else ():
                if (value := row.number(name)) is not None and not math.isnan(value):
                    values.setdefault(row.data, set()).add(value)
            choose = max if better == "higher" else min
            differ = {data: some for data, some in values.items() if len({*map(format_number, some)}) > 1}
            found |= {(name, data): choose(some) for data, some in differ.items()}
        return found

    def is_best(self, row: Row, name: str) -> bool:
        """Whether a row holds the best value of a metric on its data, or one that is shown by the same digits."""
        best = self.best.get((name, row.data))
        shown = best is not None and format_number(row.number(name)) == format_number(best)
        return shown and self._may_be_best(row)

    @cached_property
    def _several_problems(self) -> bool:
        return any(name.startswith(("model.", "operator.")) or name.endswith(".tolerance") for name in self.varying)

    @cached_property
    def some_converged(self) -> bool:
        """Whether rows say if they converged."""
        return any("converged" in row.metrics for row in self.rows)

    def _may_be_best(self, row: Row) -> bool:
        answers = row.answers and not row.limited
        certified = row.metrics.get("converged") == 1.0 and row.metrics.get("relative_gap", 0.0) <= 1.0
        return answers and (certified if self.some_converged else not row.failure)

    def excerpt(self, limit: int) -> list[Row]:
        """The first rows, and of the others some with the best value of a metric; all where they are few."""
        if len(self.rows) <= limit:
            return self.rows
        first: dict[tuple[str, frozenset[str]], int] = {}
        for place, row in enumerate(self.rows):
            for name in self.metric_names:
                if (name, row.data) not in first and self.is_best(row, name):
                    first[name, row.data] = place
        ahead = {*range(limit), *sorted(first.values())[:BEST_BEYOND]}
        return [row for place, row in enumerate(self.rows) if place in ahead]


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
        rows.append(Row(leaf, parameters, found.metrics, found.seconds, notes, failure, data, measured))
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


def comparisons(rows: list[Row]) -> list[Comparison]:
    """Group rows by the comparison that their variant names, in order of appearance."""
    groups: dict[str, Comparison] = {}
    for row in in_tables(rows):
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


def format_number(value: float | None) -> str:
    """Four significant digits, powers of ten only where they help, a dash for nothing."""
    if value is None or value != value:
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if value == int(value) and abs(value) < 1e7:
        return f"{int(value):,}".replace(",", "\u202f")
    if 1e-3 <= abs(value) < 1e6:
        return f"{value:.4g}" if abs(value) < 999.95 else f"{value:,.0f}".replace(",", "\u202f")
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def as_in_tables(note: str) -> str:
    """Return a note whose long numbers are written as tables write them, so that the two can be compared.

    Examples
    --------
    >>> as_in_tables("The energy, -39102.7, exceeds that of 25075 vertices by 0.5.").replace("\u202f", "_")
    'The energy, -39_103, exceeds that of 25_075 vertices by 0.5.'
    """
    return LONG.sub(lambda found: format_number(float(found[0])), note)


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
