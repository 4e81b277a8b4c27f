"""The language of claims: one statement, the quantity of the rows that decides it, the interval and why that interval."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from surfexp.lab.errors import UserError, unknown
from surfexp.lab.experiment.configuration import one_line

PLACES = ("table", "figure", "section", "equation", "theorem", "lemma", "remark", "chapter")
RENAMED = {"printed": "published", "of": "rows", "holds": "between"}


class Published(BaseModel):
    """Where the dissertation makes a statement, and the value that stands there."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    table: str | None = Field(None, description="number of a table")
    figure: str | None = Field(None, description="number of a figure, with its part")
    section: str | None = Field(None, description="number of a section")
    equation: str | None = Field(None, description="number of an equation")
    theorem: str | None = Field(None, description="number of a theorem")
    lemma: str | None = Field(None, description="number of a lemma")
    remark: str | None = Field(None, description="number of a remark")
    chapter: str | None = Field(None, description="number of a chapter")
    value: str = Field(min_length=1, description="the value as it stands in the text, a number or words")

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        places = [place for place in PLACES if getattr(self, place) is not None]
        if len(places) != 1:
            given = " and ".join(places) or "no place"
            raise ValueError(f"{given} given, one of {', '.join(PLACES)} is needed")
        return self

    @property
    def place(self) -> tuple[str, str]:
        """Kind and number of the place."""
        kind = next(place for place in PLACES if getattr(self, place) is not None)
        return kind, getattr(self, kind)


class Claim(BaseModel):
    """One statement as an experiment's `claims:` writes it: published, of another reference, or the experiment's own."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    claim: str = Field(min_length=1, description="one statement, prose only")
    published: Published | None = Field(None, description="where the dissertation states it, and the value there")
    reference: str = Field("", description="who else published it, for what is not the dissertation's")
    quantity: Literal["all", "any", "mean", "min", "max", "ratio"] = Field(
        description="what of the rows lies in the interval: each value, some value, their mean, their least, their "
        "largest, or their mean over that of the rows `over`"
    )
    metric: str = Field(min_length=1, description="a metric that the rows' plugin declares, or seconds")
    rows: dict[str, Any] = Field({}, description="parameters that select rows; a list of values means any of them")
    over: dict[str, Any] | None = Field(None, description="for a ratio: parameters of the rows to divide by")
    between: tuple[float | None, float | None] | None = Field(
        None, description="interval, ends included; null is an open end"
    )
    because: str = Field("", description="why that interval")
    not_comparable: str = Field(
        "",
        description="in place of an interval: why the published value and the one found here cannot be held against "
        "each other; both are shown, and there is no verdict either way",
    )
    unconverged: str = Field("", description="why rows count that stopped at their iteration limit; else they do not")
    moved: str = Field("", description="the interval before the result was seen, when it was another one")
    otherwise: Literal["corrected", "not reproduced"] | None = Field(
        None, description="verdict outside of the interval on what was published; default: not reproduced"
    )
    cause: str = Field("", description="one sentence: why it came out as it did")

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.not_comparable:
            self._check_not_comparable()
            return self
        if self.between is None or not self.because:
            missing = "because" if self.between else "between"
            raise ValueError(f"{missing!r} is missing: an interval with its reason, or not_comparable, is needed")
        low, high = self.between
        if low is None and high is None:
            raise ValueError("between: both ends are open, so that every value lies in it")
        if any(end is not None and not -float("inf") < end < float("inf") for end in self.between):
            raise ValueError("between: an end is not finite; null is an open end")
        if low is not None and high is not None and low > high:
            raise ValueError(f"between: the lower end {low:g} is above the upper end {high:g}")
        return self

    def _check_not_comparable(self) -> None:
        for name in ("between", "because", "otherwise"):
            if getattr(self, name):
                raise ValueError(f"not_comparable stands in place of {name}: without a comparison there is no interval")
        if self.published is None:
            raise ValueError("not_comparable is said of what the dissertation states; published is missing")

    @model_validator(mode="after")
    def _from_one_source(self) -> Self:
        if (self.quantity == "ratio") != (self.over is not None):
            raise ValueError(f"over is for a ratio and needed there; the quantity is {self.quantity!r}")
        if self.published and self.reference:
            raise ValueError("published is the dissertation's and reference somebody else's; give one of them")
        if self.otherwise and not self.foreign:
            raise ValueError("otherwise is a verdict on what was published or has a reference; ours does not hold")
        return self

    @property
    def foreign(self) -> bool:
        """Whether somebody else stated it: the dissertation or another reference."""
        return self.published is not None or bool(self.reference)

    @property
    def source(self) -> str:
        """Who states it, for a table: a place with its value, a reference, or "ours"."""
        if self.published:
            return f"{' '.join(self.published.place)}: {self.published.value}"
        return self.reference or "ours"


def read_claims(claims: Sequence[Any]) -> list[Claim]:
    """Check the claims of an experiment; UserError names the claim, the key and the nearest valid one."""
    return [_read(claim, number) for number, claim in enumerate(claims, 1)]


def _read(given: Any, number: int) -> Claim:
    if not isinstance(given, Mapping):
        raise UserError(f"claim {number} is {given!r}; a mapping with claim, quantity, metric and between is needed")
    where = f"claim {number} ({str(given.get('claim', 'without statement'))[:60]})"
    for key in given:
        if key in RENAMED:
            raise UserError(f"{where}: {key!r} is called {RENAMED[key]!r} now")
        if key not in Claim.model_fields:
            raise UserError(f"{where}: {unknown('key', str(key), Claim.model_fields)}")
    try:
        return Claim.model_validate(given)
    except ValidationError as error:
        missing = [str(item["loc"][-1]) for item in error.errors() if item["type"] == "missing"]
        first = error.errors()[0]
        found = one_line("claim", error) if first["loc"] else first["msg"].removeprefix("Value error, ")
        reason = f"{missing[0]!r} is missing" if missing else found
        raise UserError(f"{where}: {reason}") from None
