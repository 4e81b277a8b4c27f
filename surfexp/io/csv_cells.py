"""Cells of CSV files that a spreadsheet shows and does not run."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

from surfexp.io.replacing import replacing

# of the columns of a table; of equals the first
SEPARATORS = ",;\t"
STARTS_A_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def cell(value: Any) -> Any:
    """Return a value as it is written: text that a spreadsheet would take for a formula has a quotation mark before it.

    Labels come from file names and tables of strangers. Numbers, also those written as text, stay as they are.

    Examples
    --------
    >>> [cell(value) for value in ("=cmd|'/c calc'!A0", "-0.5", "-rf", -0.5)]
    ["'=cmd|'/c calc'!A0", '-0.5', "'-rf", -0.5]
    """
    if not isinstance(value, str) or not value.startswith(STARTS_A_FORMULA):
        return value
    try:
        float(value)
    except ValueError:
        return f"'{value}"
    return value


def uncell(text: str) -> str:
    """Return the text of a cell without the mark that `cell` has put before it."""
    return text[1:] if text.startswith("'") and cell(text[1:]) == text else text


def separator_of(lines: Sequence[str]) -> str:
    """Return what separates the columns of a table: of comma, semicolon and tab the one that makes most cells of its first rows.

    Examples
    --------
    >>> separator_of(["subject;age, in years", "sub-1;31"]), separator_of(["thickness", "2.5"]), separator_of(['"a;b",c'])
    (';', ',', ',')
    """
    rows = list(islice(filter(str.strip, lines), 2))
    return max(SEPARATORS, key=lambda separator: min((_count_cells(row, separator) for row in rows), default=0))


def _count_cells(line: str, separator: str) -> int:
    try:
        return len(next(csv.reader([line], delimiter=separator), ()))
    except csv.Error:
        return 0


def cells(row: Iterable[Any]) -> list[Any]:
    """Return the cells of a row."""
    return [cell(value) for value in row]


def write_columns(path: Path, columns: Mapping[str, Sequence[Any]]) -> None:
    """Write columns under their names; a file of the name is replaced when all is written."""
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(cells(row) for row in zip(*columns.values(), strict=True))
