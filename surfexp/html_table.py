"""Small tables by which notebooks show results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any


def html_table(title: str, facts: Mapping[str, Any], notes: Sequence[str] = ()) -> str:
    """Return a table of two columns below a title, with notes below it; all text escaped.

    Parameters
    ----------
    title : str
    facts : dict
        Numbers are written with four digits; None and empty text are left out.
    notes : sequence of str
    """
    rows = "".join(
        f'<tr><th style="text-align:left">{escape(name)}</th><td style="text-align:right">{escape(_written(value))}</td></tr>'
        for name, value in facts.items()
        if value is not None and value != ""
    )
    said = "".join(f"<div>{escape(note)}</div>" for note in notes)
    return f"<table><caption>{escape(title)}</caption>{rows}</table>{said}"


def _written(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
