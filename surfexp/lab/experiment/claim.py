"""The language of claims: one statement, the quantity of the rows that decides it, the interval and why that interval."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, Self

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from surfexp.lab.errors import UserError, unknown
from surfexp.lab.experiment.configuration import one_line

PLACES = ("table", "figure", "section", "equation", "theorem", "lemma", "remark", "chapter")
Summary = Literal["all", "any", "mean", "min", "max", "ratio"]
NOT_COMPARABLE: Literal["not comparable"] = "not comparable"
UNEXPLAINED = "No reason is given."
Interval = tuple[float | None, float | None]
Selection = dict[str, Any]


class Claim(BaseModel):
    """One statement as an experiment's `claims:` writes it: published, or the experiment's own."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    claim: str = Field(min_length=1, description="one statement, prose only")
    published: dict[str, str] = Field(
        {},
        max_length=1,
        description="who states it, and the value that stands there, a number or words: a place of the dissertation, "
        "such as {table 2.2: '20.28'}, or another reference",
    )
    quantity: dict[Summary, str] = Field(
        min_length=1,
        max_length=1,
        description="what of the rows lies in the interval, and of which metric that their plugin declares (or seconds): "
        "each value (all), some value (any), their mean, their least (min), their largest (max), or the ratio of two means",
    )
    rows: Selection | tuple[Selection, Selection] = Field(
        {},
        description="parameters that select rows; a list of values means any of them; for a ratio two selections, "
        "of the rows and of those to divide by",
    )
    between: Interval | Literal["not comparable"] = Field(
        description="interval, ends included, null is an open end; or not comparable: the value published and the one "
        "found stand side by side, and there is no verdict either way"
    )
    because: str = Field("", description="why that interval, or why it cannot be compared")
    otherwise: Literal["corrected", "not reproduced"] | None = Field(
        None, description="verdict outside of the interval on what was published; default: not reproduced"
    )
    cause: str = Field("", description="one sentence: why it came out as it did")
    moved: str = Field("", description="the interval before the result was seen, when it was another one")
    unconverged: str = Field("", description="why rows count that stopped at their iteration limit; else they do not")

    @field_validator("published")
    @classmethod
    def _one_source(cls, published: dict[str, str]) -> dict[str, str]:
        for source, value in published.items():
            word, _, number = source.partition(" ")
            near = difflib.get_close_matches(word, PLACES, 1, 0.75)
            if word in PLACES and not number.strip():
                raise ValueError(f"{source!r} has no number: write {{{word} NUMBER: VALUE}}")
            if word not in PLACES and near:
                raise ValueError(f"{word!r} is no kind of place; did you mean {near[0]!r}?")
            if not source or not value:
                raise ValueError("a source and the value that stands there are needed: {table 2.2: '20.28'}")
        return published

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.summary == "ratio") != isinstance(self.rows, tuple):
            raise ValueError(f"rows: a ratio needs two selections and nothing else has two; this is {self.summary!r}")
        if self.otherwise and not self.published:
            raise ValueError("otherwise is a verdict on what was published; ours does not hold")
        if self.published and not self.because:
            raise ValueError("'because' is missing: the reason of an interval on what was published is needed")
        if self.between == NOT_COMPARABLE:
            if not self.place:
                raise ValueError("not comparable is said of what the dissertation states; published has no place of it")
            if self.otherwise:
                raise ValueError("otherwise: what is not comparable has no verdict")
            return self
        low, high = self.between
        if low is None and high is None:
            raise ValueError("between: both ends are open, so that every value lies in it")
        if any(end is not None and not -float("inf") < end < float("inf") for end in self.between):
            raise ValueError("between: an end is not finite; null is an open end")
        if low is not None and high is not None and low > high:
            raise ValueError(f"between: the lower end {low:g} is above the upper end {high:g}")
        return self

    @property
    def summary(self) -> Summary:
        """What of the rows is judged: all, any, mean, min, max or ratio."""
        return next(iter(self.quantity))

    @property
    def metric(self) -> str:
        """The metric of the rows that is judged."""
        return next(iter(self.quantity.values()))

    @property
    def selections(self) -> tuple[Selection, ...]:
        """The parameters that select rows, of a ratio also those that select the rows to divide by."""
        return self.rows if isinstance(self.rows, tuple) else (self.rows,)

    @property
    def interval(self) -> Interval | None:
        """The interval; None where there is no comparison."""
        return None if self.between == NOT_COMPARABLE else self.between

    @property
    def place(self) -> tuple[str, str] | None:
        """Kind and number of the place in the dissertation; None for another reference, and for what is ours."""
        for source in self.published:
            kind, _, number = source.partition(" ")
            return (kind, number) if kind in PLACES else None
        return None

    @property
    def value(self) -> str:
        """The value as it was published, empty for what is ours."""
        return next(iter(self.published.values()), "")

    @property
    def reason(self) -> str:
        """Why that interval, for a table."""
        return self.because or UNEXPLAINED

    @property
    def source(self) -> str:
        """Who states it, for a table: a place or a reference with its value, or "ours"."""
        return next((f"{source}: {value}" for source, value in self.published.items()), "ours")


def claims_of(file: Path) -> list[Any]:
    """Return the claims of an experiment's file, as they stand there."""
    return yaml.safe_load(file.read_text(encoding="utf-8")).get("claims") or []


def read_claims(claims: Sequence[Any]) -> list[Claim]:
    """Check the claims of an experiment; UserError names the claim, the key and the nearest valid one."""
    return [_read(claim, number) for number, claim in enumerate(claims, 1)]


def _read(given: Any, number: int) -> Claim:
    if not isinstance(given, Mapping):
        raise UserError(f"claim {number} is {given!r}; a mapping with claim, quantity and between is needed")
    where = f"claim {number} ({str(given.get('claim', 'without statement'))[:60]})"
    for key in given:
        if key not in Claim.model_fields:
            raise UserError(f"{where}: {unknown('key', str(key), Claim.model_fields)}")
    if isinstance(quantity := given.get("quantity"), Mapping):
        for key in quantity:
            if key not in Summary.__args__:  # type: ignore[attr-defined]
                raise UserError(f"{where}: {unknown('quantity', str(key), Summary.__args__)}")  # type: ignore[attr-defined]
    try:
        return Claim.model_validate(given)
    except ValidationError as error:
        missing = [str(item["loc"][-1]) for item in error.errors() if item["type"] == "missing"]
        first = error.errors()[0]
        found = one_line("claim", error)
        if first["type"] == "value_error":
            found = first["msg"].removeprefix("Value error, ")
        reason = f"{missing[0]!r} is missing" if missing else found
        raise UserError(f"{where}: {reason}") from None
