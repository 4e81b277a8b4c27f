"""How results show themselves: one line at a prompt, a small table in a notebook."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any


@dataclass(frozen=True)
class Summary:
    """What a person should see of a result first.

    Parameters
    ----------
    title : str
    facts : dict
        Numbers are written with four digits; None and empty text are left out.
    notes : sequence of str
        Sentences that must not be missed.
    """

    title: str
    facts: Mapping[str, Any]
    notes: Sequence[str] = field(default=())

    def rows(self) -> dict[str, str]:
        """Write out the facts that are known.

        Returns
        -------
        dict of str to str
        """
        return {name: _written(value) for name, value in self.facts.items() if value is not None and value != ""}

    def line(self, kind: str) -> str:
        """Write one line for a prompt, as ``<Distance: spectral distance, lower bound 0.1>``.

        Parameters
        ----------
        kind : str
            Name of the class.

        Returns
        -------
        str
            Notes are counted, not shown.
        """
        said = ", ".join([" ".join(self.title.split()), *(f"{name} {value}" for name, value in self.rows().items())])
        count = len(self.notes)
        return f"<{kind}: {said}{f'; {count} note' + 's' * (count > 1) if count else ''}>"

    def table(self) -> str:
        """Write a table of two columns below the title, with the notes below it; all text escaped.

        Returns
        -------
        str
            HTML.
        """
        rows = "".join(
            f'<tr><th style="text-align:left">{escape(name)}</th><td style="text-align:right">{escape(value)}</td></tr>'
            for name, value in self.rows().items()
        )
        said = "".join(f"<div>{escape(note)}</div>" for note in self.notes)
        return f"<table><caption>{escape(self.title)}</caption>{rows}</table>{said}"


class Summarized:
    """A result that shows its summary; a dataclass must say ``repr=False`` to keep it."""

    def _summary(self) -> Summary:
        raise NotImplementedError

    def __repr__(self) -> str:
        return self._summary().line(type(self).__name__)

    def _repr_html_(self) -> str:
        return self._summary().table()


def _written(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
