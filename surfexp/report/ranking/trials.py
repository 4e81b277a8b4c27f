"""Rows of a table as trials: methods on problems that they share.

A problem is the data and the tolerance that was asked for; all else that differs between rows is the method. Tests count
data: one image at three tolerances is three problems and one sample.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.metric import Metric
from surfexp.records.comparison import OF_ONE_PROBLEM, Comparison
from surfexp.records.table import SECONDS, Row
from surfexp.records.written_numbers import format_number, short_name
from surfexp.report.words import word

# of n differences alike in sign the signed-rank test gives 2^(1 - n): under six no test can reach 5 %
FEWEST_DATA, MOST_METHODS = 6, 12

# the data, and the values of the options that belong to the task
Problem = tuple[frozenset[str], tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class Trials:
    """One metric of several methods on the same problems.

    Parameters
    ----------
    metric : str
    better : "lower" or "higher"
    unit : str
    methods : tuple of str
        At least two, in the order of the table.
    values : (n, m) float64
        A row a problem, a column a method; NaN where it failed or did not converge.
    left_out : tuple of str
        Methods with rows on other problems only, or on fewer than half of them.
    data : tuple of int
        Number of each problem's data; problems of the same data differ by their tolerance. Empty: every problem has its
        own.
    """

    metric: str
    better: str
    unit: str
    methods: tuple[str, ...]
    values: Floats
    left_out: tuple[str, ...] = ()
    data: tuple[int, ...] = ()

    @property
    def samples(self) -> Integers:
        """Number of each problem's data, from 0."""
        return np.unique(self.data or range(len(self.values)), return_inverse=True)[1].astype(np.int64)

    @property
    def failed(self) -> tuple[int, ...]:
        """How many problems each method did not solve."""
        return tuple(int(count) for count in np.isnan(self.values).sum(axis=0))


def trials_of(group: Comparison) -> list[Trials]:
    """The trials of each metric with a good direction; none where fewer than two methods share six data.

    Numbers that tell where a method stopped, such as its gap, are no merit and have none, nor have energies of several
    models. Solvers that are certified to minimise the same energy are ranked by seconds alone: what else differs between
    their minimisers is where they stopped.
    """
    rows = [row for row in group.rows if row.answers]
    if not rows:
        return []
    of_problem = [name for name in group.varying if _belongs_to_problem(name, rows)]
    of_method = [name for name in group.varying if name not in of_problem]
    names = _telling(rows, of_method)
    of_problem = [name for name in of_problem if _is_task(name)]
    methods = _names([{name: _said(row, name) for name in names if name in row.parameters} for row in rows])
    problems = [(row.data, tuple(str(row.parameters.get(name)) for name in of_problem)) for row in rows]
    places = dict[tuple[str, Problem], Row]()
    for method, problem, row in zip(methods, problems, rows, strict=True):
        if (method, problem) in places:
            return []  # two rows of one method on one problem: something else differs than a method
        places[method, problem] = row
    kept, shared = _complete(places)
    numbers = {data: number for number, data in enumerate(dict.fromkeys(data for data, _ in shared))}
    if not 2 <= len(kept) <= MOST_METHODS or len(numbers) < FEWEST_DATA:
        return []
    left_out = tuple(method for method in dict.fromkeys(methods) if method not in kept)
    no_merit = {*OF_ONE_PROBLEM, *(["energy"] if any("model." in name for name in of_method) else [])}
    if _only_stop_elsewhere(of_method, rows):
        no_merit.update(group.metric_names)
    by_clock = [SECONDS] if group.meaning(SECONDS).better and all(row.seconds is not None for row in rows) else []
    found, of_data = [], tuple(numbers[data] for data, _ in shared)
    for metric in [*(name for name in group.metric_names if name != SECONDS), *by_clock]:
        meaning = group.meaning(metric) if metric != SECONDS else Metric("", "s", "lower")
        values = np.array([[_value(places[method, problem], metric) for method in kept] for problem in shared])
        if meaning.better and metric not in no_merit and len(set(values[~np.isnan(values)].tolist())) > 1:
            found.append(Trials(metric, meaning.better, meaning.unit, tuple(kept), values, left_out, of_data))
    return found


def _is_task(name: str) -> bool:
    return name.endswith(".tolerance")


def _only_stop_elsewhere(names: Sequence[str], rows: Sequence[Row]) -> bool:
    of_solvers = all(name.rpartition(".")[0].split(".")[-1] == "solver" for name in names)
    return of_solvers and all("relative_gap" in row.metrics for row in rows if not row.failure)


def _belongs_to_problem(name: str, rows: Sequence[Row]) -> bool:
    """Whether a column is a part of the task, or says nothing beyond the data."""
    if _is_task(name):
        return True
    by_data: dict[frozenset[str], str] = {}
    return all(
        by_data.setdefault(row.data, value) == value for row in rows for value in [str(row.parameters.get(name))]
    )


def _telling(rows: Sequence[Row], names: Sequence[str]) -> list[str]:
    """The columns that tell methods apart, without those that follow from columns before them."""
    kept: list[str] = []
    for name in names:
        seen: dict[tuple[str, ...], str] = {}
        for row in rows:
            before = tuple(str(row.parameters.get(other)) for other in kept)
            if seen.setdefault(before, str(row.parameters.get(name))) != str(row.parameters.get(name)):
                kept.append(name)
                break
    return kept


def _names(said: Sequence[Mapping[str, str]]) -> list[str]:
    """What tells each row's method apart, by columns, without a column that the others say already."""
    kept = [dict(columns) for columns in said]
    for name in dict.fromkeys(name for columns in said for name in columns):
        fewer = [{key: text for key, text in columns.items() if key != name or len(columns) == 1} for columns in kept]
        if len({", ".join(columns.values()) for columns in fewer}) == len(
            {", ".join(columns.values()) for columns in kept}
        ):
            kept = fewer
    return [", ".join(columns.values()) for columns in kept]


def _said(row: Row, name: str) -> str:
    value = row.parameters[name]
    if name.endswith((".name", ".method")):
        return str(value).replace("_", " ")
    said = format_number(value) if isinstance(value, float) else word(value)
    return f"{short_name(name)} {said}"


def _complete(places: Mapping[tuple[str, Problem], Row]) -> tuple[list[str], list[Problem]]:
    """Methods with rows on more than half of the problems, and the problems on which all of them have one."""
    counts = Counter(method for method, _ in places)
    problems = dict.fromkeys(problem for _, problem in places)
    kept = [method for method, count in counts.items() if 2 * count > len(problems)]
    return kept, [problem for problem in problems if all((method, problem) in places for method in kept)]


def _value(row: Row, metric: str) -> float:
    if row.failure or row.limited:
        return math.nan
    value = row.number(metric)
    return math.nan if value is None else float(value)
