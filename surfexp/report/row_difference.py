"""Two rows beside each other: what was asked differently, and what came out."""

from __future__ import annotations

from typing import Any

from surfexp.records.table import Row

ABSENT = "–"


def differing_options(one: Row, other: Row) -> dict[str, tuple[Any, Any]]:
    """Return the parameters in which two rows differ, in the order of the first; one that a row lacks is a dash."""
    names = dict.fromkeys([*one.parameters, *other.parameters])
    pairs = {name: (one.parameters.get(name, ABSENT), other.parameters.get(name, ABSENT)) for name in names}
    return {name: pair for name, pair in pairs.items() if str(pair[0]) != str(pair[1])}


Numbers = tuple[float | None, float | None, float | None, float | None]


def numbers_beside(one: Row, other: Row) -> dict[str, Numbers]:
    """Return both values of each metric and of the seconds, second less first, and second over first if a number."""
    found: dict[str, Numbers] = {}
    for name in dict.fromkeys([*one.metrics, *other.metrics, "seconds"]):
        first, second = (row.number(name) for row in (one, other))
        if first is None or second is None:
            found[name] = (first, second, None, None)
        else:
            found[name] = (first, second, second - first, second / first if first else None)
    return found
