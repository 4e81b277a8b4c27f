"""What the dissertation states, place by place: what it says, and why there is no verdict where there can be none."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, cast

CHAPTERS = {
    1: "Operators",
    2: "Images on surfaces",
    3: "Laplace-Beltrami spectra",
    4: "Nodal counts and signatures",
    5: "Reeb graphs and skeletons",
    6: "Embeddings and their distance",
}


@dataclass(frozen=True)
class Statement:
    """A table, figure, theorem, equation or section, and what it says.

    Parameters
    ----------
    id : str
        Kind and number, such as "table 2.2".
    section : str
    states : str
    verdicts : tuple of str
        Experiments whose claims cite it.
    none : str
        Why there can be no verdict; empty where there is one.
    ours : tuple of str
        Experiments that measure it without a verdict on it.
    values : tuple of str
        Numbers and words as they stand in the text.
    """

    id: str
    section: str
    states: str
    verdicts: tuple[str, ...] = ()
    none: str = ""
    ours: tuple[str, ...] = ()
    values: tuple[str, ...] = ()

    @property
    def place(self) -> tuple[str, str]:
        """Kind and number, without the part of a figure."""
        kind, number = self.id.split()[:2]
        return kind, number

    @property
    def chapter(self) -> int:
        """The chapter in which it stands."""
        return int(self.section.partition(".")[0])


@cache
def statements() -> tuple[Statement, ...]:
    """Return all statements in the order of the text."""
    import yaml

    text = files("surfexp.reproduction").joinpath("statements.yaml").read_text(encoding="utf-8")
    return tuple(_read(entry) for entry in yaml.safe_load(text)["statements"])


def _read(entry: dict[str, Any]) -> Statement:
    known = {name: tuple(value) if isinstance(value, list) else str(value).strip() for name, value in entry.items()}
    return Statement(**cast("dict[str, Any]", known))
