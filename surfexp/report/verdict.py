"""Claims held against the rows of an experiment: a verdict on each, or the rows that leave it not computed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from statistics import fmean
from typing import Any

from surfexp.lab.experiment.claim import NOT_COMPARABLE, Claim, Interval
from surfexp.lab.plan.outcome import NOT_COMPUTED
from surfexp.records.comparison import Comparison
from surfexp.records.table import SECONDS, Row
from surfexp.records.written_numbers import format_number


@dataclass(frozen=True)
class Verdict:
    """A claim, what was found, and what follows.

    `value` is the quantity where it is one number (mean, min, max, ratio); `low` and `high` are the least and the
    largest value of the rows, of a ratio those over all pairs of rows. `obstacle` names the rows that leave it not
    computed.
    """

    claim: Claim
    verdict: str
    count: int
    value: float | None = None
    low: float | None = None
    high: float | None = None
    obstacle: str = ""

    @property
    def interval(self) -> str:
        """The numbers between which the quantity is asked to lie, for a table."""
        if self.claim.interval is None:
            return "–"
        low, high = (None if end is None else f"{end:.15g}" for end in self.claim.interval)
        if low is None or high is None:
            return f"≥ {low}" if low is not None else f"≤ {high}"
        return low if low == high else f"{low} to {high}"

    @property
    def quantity(self) -> str:
        """What of the rows is judged, for a table."""
        return f"{self.claim.summary} {self.claim.metric}"

    @property
    def number(self) -> str:
        """The quantity with the range of the rows for a table."""
        if self.low is None or self.high is None:
            return "–"
        low, high = map(self._shown, (self.low, self.high))
        spread = f"{low} to {high}"
        if self.value is None:
            return spread if self.high > self.low else low
        return self._shown(self.value) + (f" ({spread})" if self.high > self.low else "")

    def _shown(self, value: float) -> str:
        """A number as tables show it, with more digits where rounding would move it over an end of the interval."""
        between = self.claim.interval
        shown = (format_number(value), *(f"{value:.{digits}g}" for digits in range(5, 17)))
        right = (text for text in shown if between is None or _same_side(between, value, text))
        return next(right, repr(value))

    @property
    def why(self) -> str:
        """What stands beside the verdict: the rows that leave it not computed, why it cannot be compared, or its cause."""
        why = self.claim.because if self.claim.interval is None else ""
        return self.obstacle or " ".join(text for text in (why, self.claim.cause) if text)


class _Obstacle(Exception):
    """Why a claim is not computed, with the rows that stop it."""


def selected(wanted: Mapping[str, Any], rows: Sequence[Row]) -> list[Row]:
    """The rows whose parameters have the wanted values; a list of values means any of them."""
    return [row for row in rows if all(has(row, name, value) for name, value in wanted.items())]


def has(row: Row, name: str, wanted: Any) -> bool:
    """Whether a row's parameter has a wanted value, or one of a list of them."""
    value = row.parameters.get(name)
    return equal(value, wanted) or (isinstance(wanted, list | tuple) and any(equal(value, item) for item in wanted))


def equal(value: Any, other: Any) -> bool:
    """Equality of option values: numbers by value, truth values apart from numbers, lists and tuples alike."""
    if isinstance(value, list | tuple) and isinstance(other, list | tuple):
        return len(value) == len(other) and all(map(equal, value, other))
    return isinstance(value, bool) == isinstance(other, bool) and bool(value == other)


def judge(claims: Sequence[Claim], rows: Sequence[Row]) -> list[Verdict]:
    """Compute every claim of an experiment from its rows."""
    return [_judge(claim, rows) for claim in claims]


def _judge(claim: Claim, rows: Sequence[Row]) -> Verdict:
    selections = [selected(wanted, rows) for wanted in claim.selections]
    chosen = selections[0]
    try:
        values, *divisors = [_values(claim, those) for those in selections]
        kinds = Comparison("", "", [row for those in selections for row in those], []).machines
        if divisors and claim.metric == SECONDS and len(kinds) > 1:
            raise _Obstacle(f"seconds of {len(kinds)} kinds of machine do not compare: {', '.join(sorted(kinds))}")
        value, low, high = _quantity(claim, values, divisors[0] if divisors else None)
    except _Obstacle as obstacle:
        return Verdict(claim, NOT_COMPUTED, len(chosen), obstacle=str(obstacle))
    if claim.interval is None:
        return Verdict(claim, NOT_COMPARABLE, len(chosen), value, low, high)
    inside = [_lies_inside(claim.interval, number) for number in (values if value is None else [value])]
    holds = any(inside) if claim.summary == "any" else all(inside)
    words = ("reproduced", claim.otherwise or "not reproduced") if claim.published else ("holds", "does not hold")
    return Verdict(claim, words[0] if holds else words[1], len(chosen), value, low, high)


def _same_side(between: Interval, value: float, shown: str) -> bool:
    return _lies_inside(between, float(shown.replace("\u202f", ""))) == _lies_inside(between, value)


def _lies_inside(between: Interval, number: float) -> bool:
    low, high = between
    return (low is None or number >= low) and (high is None or number <= high)


def _values(claim: Claim, rows: Sequence[Row]) -> list[float]:
    """The metric of every row; nothing is computed from rows that failed, lack it, or have not converged."""
    if not rows:
        raise _Obstacle("no row is selected")
    unusable = {
        "not run": [row for row in rows if row.failure == NOT_COMPUTED],
        "failed": [row for row in rows if row.failure not in ("", NOT_COMPUTED)],
        f"without {claim.metric}": [row for row in rows if not row.failure and value_of(row, claim.metric) is None],
        "not converged": [] if claim.unconverged or claim.metric == "converged" else [r for r in rows if r.limited],
    }
    told = [f"{reason}: {_names(those, rows)}" for reason, those in unusable.items() if those]
    if told:
        raise _Obstacle("; ".join(told))
    return [value for row in rows if (value := value_of(row, claim.metric)) is not None]


def value_of(row: Row, metric: str) -> float | None:
    """A finite metric of a row, or its seconds; None where there is none."""
    value = row.number(metric)
    return float(value) if value is not None and abs(value) < float("inf") else None


def _names(those: Sequence[Row], rows: Sequence[Row]) -> str:
    columns = Comparison("", "", list(rows), []).varying
    names = [" ".join(str(row.parameters.get(name, "–")) for name in columns) for row in those[:3]]
    more = f" and {len(those) - 3} more" if len(those) > 3 else ""
    return f"{', '.join(names)}{more} ({len(those)} of {len(rows)} rows)"


def _quantity(claim: Claim, values: list[float], divisors: list[float] | None) -> tuple[float | None, float, float]:
    if divisors is None:
        aggregates = {"mean": fmean(values), "min": min(values), "max": max(values)}
        return aggregates.get(claim.summary), min(values), max(values)
    if 0.0 in divisors or fmean(divisors) == 0.0:
        raise _Obstacle(f"{claim.metric} is 0 in rows to divide by")
    # the extremes over all pairs are at extremes of either side, below apart for either sign: a quotient is monotone there
    above = (min(values), max(values))
    signs = ([one for one in divisors if one > 0.0], [one for one in divisors if one < 0.0])
    below = [end for side in signs if side for end in (min(side), max(side))]
    ratios = [numerator / divisor for numerator, divisor in product(above, below)]
    return fmean(values) / fmean(divisors), min(ratios), max(ratios)
