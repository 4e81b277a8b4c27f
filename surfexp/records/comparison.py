"""Comparisons: the rows of one table, what tells them apart and which of them is best."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from surfexp.contract.metric import Metric, find_metric
from surfexp.records.table import SECONDS, Row, in_tables
from surfexp.records.written_numbers import format_number

# rows with a best value that an excerpt has beyond the first ones
BEST_BEYOND = 50
# what depends on the model, on its operator and on where a solver stops: a best among rows of different ones means nothing
OF_ONE_PROBLEM = ("gap", "relative_gap", "lower_bound", "error_bound", "iterations", "evaluations", "updates")
# where a certified row stopped below its tolerance, or what chance would give: a smaller one is no better
NO_MERIT = ("gap", "lower_bound", "error_bound", "p_value")


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

        Seconds have a good direction only in benchmark mode, where stages run one at a time, and on machines of one kind.
        """
        if name == SECONDS:
            timed = all(row.leaf.settings.get("timing") for row in self.rows) and len(self.machines) < 2
            return Metric("processor seconds of the stage, without compilation", "s", "lower" if timed else "")
        return find_metric(name, self.metrics) or Metric("")

    @cached_property
    def machines(self) -> dict[str, int]:
        """The kinds of machine that rows with seconds were measured on, with their number; unknown is one of them."""
        return dict(Counter(row.machine or "unknown" for row in self.rows if row.seconds is not None))

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
