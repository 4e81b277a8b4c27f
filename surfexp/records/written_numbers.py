"""Numbers, notes and headings as tables write them."""

from __future__ import annotations

import math
import re

# numbers of a note that tables write with spaces between thousands
LONG = re.compile(r"(?<![\w./,-])-?(?:\d{5,6}(?:\.\d+)?|\d{4}\.\d+)(?!\.?\w)")


def format_number(value: float | None) -> str:
    """Four significant digits; powers of ten with two, for errors and gaps, only below 1e-3 and from 1e6; a dash for nothing."""
    if value is None or value != value:
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    if value == int(value) and abs(value) < 1e7:
        return f"{int(value):,}".replace(",", "\u202f")
    if 1e-3 <= abs(value) < 1e6:
        return f"{value:.4g}" if abs(value) < 999.95 else f"{value:,.0f}".replace(",", "\u202f")
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def as_in_tables(note: str) -> str:
    """Return a note whose long numbers are written as tables write them, so that the two can be compared.

    Examples
    --------
    >>> as_in_tables("The energy, -39102.7, exceeds that of 25075 vertices by 0.5.").replace("\u202f", "_")
    'The energy, -39_103, exceeds that of 25_075 vertices by 0.5.'
    """
    return LONG.sub(lambda found: format_number(float(found[0])), note)


def short_name(parameter: str) -> str:
    """Heading of a parameter's column: the stage for a plugin's name, the option otherwise."""
    stage, _, option = parameter.rpartition(".")
    return (
        stage
        if option == "name"
        else parameter
        if "[" in parameter
        else f"{stage.split('.')[-1]} {option}".replace("_", " ")
    )
