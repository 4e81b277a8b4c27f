"""Published claims held against the numbers of an experiment: reproduced, corrected or not reproduced, computed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from surfexp.report.table import Row, format_number


class Claim(BaseModel):
    """One statement as an experiment's `claims:` writes it, published or the experiment's own.

    The number is the mean of `metric` over the rows that match `of`, divided by its mean over those that match `over`
    when that is given. It reproduces the claim when it lies in the interval `holds`. A statement with nothing printed
    is the experiment's own, and "holds" or "does not hold".
    """

    model_config = ConfigDict(extra="forbid")

    claim: str = Field(description="the statement, with its place in the dissertation")
    printed: str = Field("", description="the number as printed, or the word stated; empty for a statement of our own")
    metric: str = Field(description="a metric of the rows, or seconds")
    of: dict[str, Any] = Field({}, description="parameters that select rows")
    over: dict[str, Any] | None = Field(None, description="parameters of the rows to divide by")
    holds: tuple[float | None, float | None] = Field(description="interval of numbers that reproduce the claim")
    otherwise: Literal["corrected", "not reproduced"] = Field("not reproduced", description="verdict outside of it")
    cause: str = Field("", description="one sentence: why it is so")


@dataclass(frozen=True)
class Verdict:
    """A claim with its number, the interval over matching rows, and what follows."""

    claim: Claim
    value: float | None
    low: float | None
    high: float | None
    verdict: str

    @property
    def interval(self) -> str:
        """The numbers that reproduce the claim, for a table."""
        low, high = (None if end is None else f"{end:g}" for end in self.claim.holds)
        if low is None or high is None:
            return f"≥ {low}" if low is not None else f"≤ {high}" if high is not None else "any"
        return low if low == high else f"{low} to {high}"

    @property
    def number(self) -> str:
        """The number with its interval for a table."""
        if self.value is None or self.low is None or self.high is None:
            return "–"
        spread = f" ({format_number(self.low)} to {format_number(self.high)})" if self.high > self.low else ""
        return format_number(self.value) + spread


def judge(claims: Sequence[Mapping[str, Any]], rows: Sequence[Row]) -> list[Verdict]:
    """Compute every claim of an experiment from its rows; "not computed" where rows are missing or failed."""
    return [_judge(Claim.model_validate(claim), rows) for claim in claims]


def _judge(claim: Claim, rows: Sequence[Row]) -> Verdict:
    above = _values(claim.metric, claim.of, rows)
    below = [1.0] if claim.over is None else _values(claim.metric, claim.over, rows)
    if not above or not below or fmean(below) == 0.0:
        return Verdict(claim, None, None, None, "not computed")
    value = fmean(above) / fmean(below)
    low, high = min(above) / max(below), max(above) / min(below)
    lower, upper = claim.holds
    holds = (lower is None or value >= lower) and (upper is None or value <= upper)
    words = ("reproduced", claim.otherwise) if claim.printed else ("holds", "does not hold")
    return Verdict(claim, value, low, high, words[0] if holds else words[1])


def _values(metric: str, wanted: Mapping[str, Any], rows: Sequence[Row]) -> list[float]:
    matching = [
        row for row in rows if all(str(row.parameters.get(name)) == str(value) for name, value in wanted.items())
    ]
    found = [row.seconds if metric == "seconds" else row.metrics.get(metric) for row in matching if not row.failure]
    return [float(value) for value in found if value is not None]


def as_markdown(experiment: str, title: str, verdicts: Sequence[Verdict]) -> str:
    """One section of `docs/reproduction.md`."""
    lines = [f"## {title or experiment}", "", f"`surfexp run experiment={experiment}`", ""]
    lines += ["| claim | printed | holds for | found | verdict | why |", "|---|---|---|---|---|---|"]
    for item in verdicts:
        cells = (
            item.claim.claim,
            item.claim.printed or "–",
            item.interval,
            item.number,
            f"**{item.verdict}**",
            item.claim.cause or "–",
        )
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join([*lines, ""])
