"""Rows that differ by seeds alone, as mean and deviation: what a table of repetitions says."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean, stdev
from typing import Any

from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.records.written_numbers import format_number

FEWEST = 3
# decimals, or digits behind the first, that are shown at most
LAST_PLACE = 5


@dataclass(frozen=True)
class RepeatedRow:
    """Rows alike but for their seeds.

    Parameters
    ----------
    parameters : dict
        What they have in common, by the columns of `Repeats`.
    count, solved : int
        How many there are, and how many of them converged and did not fail: these are averaged.
    metrics : dict of str to (float, float)
        Mean and standard deviation (with count - 1) of each metric; the deviation of a single value, and of
        infinite ones, is NaN.
    known : dict of str to int
        Over how many rows: those that are solved and whose metric is a number.
    """

    parameters: dict[str, Any]
    count: int
    solved: int
    metrics: dict[str, tuple[float, float]]
    known: dict[str, int]

    def shown(self, name: str) -> str:
        """Mean and deviation of a metric as tables show them, over how many rows where those are fewer; a dash for nothing."""
        if name not in self.metrics:
            return "–"
        fewer = f" (of {self.known[name]})" if self.known[name] < self.solved else ""
        return mean_and_deviation(*self.metrics[name]) + fewer


@dataclass(frozen=True)
class Repeats:
    """The table of a comparison without its seeds.

    Parameters
    ----------
    seeds : list of str
        The columns that are left out.
    columns : list of str
        The columns that are left.
    metrics : list of str
    rows : list of RepeatedRow
    """

    seeds: list[str]
    columns: list[str]
    metrics: list[str]
    rows: list[RepeatedRow]


def repeats_of(group: Comparison) -> Repeats | None:
    """The repetitions of a table; None where nothing is repeated at least three times by a seed."""
    seeds = [name for name in group.varying if name.rpartition(".")[2] == "seed"]
    if not seeds:
        return None
    columns = [name for name in group.varying if name not in seeds]
    alike: dict[tuple[str, ...], list[Row]] = {}
    for row in group.rows:
        alike.setdefault(tuple(str(row.parameters.get(name)) for name in columns), []).append(row)
    if min(map(len, alike.values())) < FEWEST:
        return None
    rows = [_repeated(rows, columns, group.metric_names) for rows in alike.values()]
    return Repeats(seeds, columns, group.metric_names, rows)


def _repeated(rows: Sequence[Row], columns: Sequence[str], names: Sequence[str]) -> RepeatedRow:
    solved = [row for row in rows if not row.failure and not row.limited]
    values = {
        name: [value for row in solved if (value := row.number(name)) is not None and not math.isnan(value)]
        for name in names
    }
    metrics = {name: _moments(some) for name, some in values.items() if some}
    parameters = {name: rows[0].parameters[name] for name in columns if name in rows[0].parameters}
    return RepeatedRow(parameters, len(rows), len(solved), metrics, {name: len(values[name]) for name in metrics})


def _moments(values: Sequence[float]) -> tuple[float, float]:
    """Mean and standard deviation; one value has no deviation, nor have infinite ones."""
    if not all(map(math.isfinite, values)):
        return sum(values) / len(values), math.nan
    return fmean(values), stdev(values) if len(values) > 1 else math.nan


def mean_and_deviation(mean: float, deviation: float) -> str:
    """Two digits of the deviation, and the mean to the same place; powers of ten only where they help.

    Examples
    --------
    >>> mean_and_deviation(15.0812, 0.1979), mean_and_deviation(20408.0, 130.0), mean_and_deviation(3.0, 0.0)
    ('15.08 ± 0.20', '20410 ± 130', '3 ± 0')
    >>> mean_and_deviation(9.3e-05, 2.4e-06), mean_and_deviation(1.5, float("nan"))
    ('9.30e-5 ± 2.4e-6', '1.5')
    """
    if math.isnan(deviation) or not math.isfinite(mean + deviation):
        return format_number(mean)
    if deviation == 0.0:
        return f"{format_number(mean)} ± 0"
    place = 1 - math.floor(math.log10(deviation))
    if place <= LAST_PLACE and max(abs(mean), deviation) < 1e6:
        return f"{round(mean, place):.{max(place, 0)}f} ± {round(deviation, place):.{max(place, 0)}f}"
    digits = place + math.floor(math.log10(abs(mean))) if mean else 0
    if not 1 <= digits <= LAST_PLACE:
        return f"{format_number(mean)} ± {format_number(deviation)}"
    return f"{_short_exponent(f'{mean:.{digits}e}')} ± {_short_exponent(f'{deviation:.1e}')}"


def _short_exponent(text: str) -> str:
    mantissa, exponent = text.split("e")
    return f"{mantissa}e{int(exponent)}"
