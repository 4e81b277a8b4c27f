"""Maps as numbers in text: .csv with a header of names or without, .txt, .dat."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.io.csv_cells import cell, separator_of, uncell
from surfexp.io.numbers import real_array

# one number as much of the world writes it, or two whole ones
DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+([eE][-+]?\d+)?")
UNKNOWN = {"", "na", "n/a", "nan", "null", "none"}


def read_table(path: Path, columns: int = 1) -> dict[str, Floats]:
    """Return the columns of a text table by name, or by number from 1; empty cells and NA are NaN.

    Columns are separated by white space, in .csv by commas, semicolons or tabs: what makes most cells of its first rows. A first
    column that has no name and counts the rows from 0 or 1, as the index of pandas and the row names of R do, is no map.

    Parameters
    ----------
    path : Path
    columns : int
        How many are known to be there: of two, 1,0 is no number with a decimal comma.

    Raises
    ------
    ValueError
        If a row has another length than the first, or a cell is no number, or has a decimal comma; if columns have no names
        and all rows may be one number with a decimal comma; or if the first alone has no name and does not count the rows.
    """
    lines = [line.strip(" ") for line in path.read_text("utf-8-sig").splitlines() if not line.lstrip().startswith("#")]
    if path.suffix.lower() == ".csv":
        rows = list(filter(None, csv.reader(lines, delimiter=separator_of(lines))))
    else:
        rows = list(filter(None, map(str.split, lines)))
    if not rows:
        raise ValueError("it holds no row")
    if columns < 2 and all(map(DECIMAL_COMMA.fullmatch, filter(None, lines))):
        raise ValueError(
            f"its rows, as {next(filter(None, lines))!r}, are one number with a decimal comma or two: name the columns in a "
            "first row, or write decimal points"
        )
    counted = _are_counted(rows)
    header = [] if all(map(_is_number, rows[0])) and not counted else [uncell(word.strip()) for word in rows.pop(0)]
    width = len(header) or len(rows[0])
    for number, row in enumerate(rows, 1 + bool(header)):
        if len(row) != width:
            raise ValueError(f"row {number} has {len(row)} cells, {width} are needed")
        for word in row:
            if not _is_number(word):
                decimal = ", with a decimal point" if _is_number(word.replace(",", ".", 1)) else ""
                raise ValueError(f"row {number} has the cell {word[:20]!r}, a number is needed{decimal}")
    values = np.array([list(map(_number, row)) for row in rows], dtype=np.float64).reshape(len(rows), width)
    if counted:
        header, values, width = header[1:], values[:, 1:], width - 1
    elif header and not header[0] and any(header):
        raise ValueError("its first column has no name and does not count the rows: name it, or leave it out")
    names = header or [f"map {k + 1}" for k in range(width)]
    if len(set(names)) < len(names):
        raise ValueError(f"two columns have the name {next(name for name in names if names.count(name) > 1)!r}")
    return {name: real_array(values[:, k].copy(), f"column {name!r}") for k, name in enumerate(names)}


def _are_counted(rows: Sequence[Sequence[str]]) -> bool:
    """Whether the first column has no name and counts the rows from 0 or 1, so that the others have names."""
    top, *words = (row[0].strip() for row in rows)
    counts = ([str(k) for k in range(first, first + len(words))] for first in (0, 1))
    return not top and len(rows[0]) > 1 and len(words) > 0 and words in counts


def check_column_names(path: Path, names: Iterable[str]) -> None:
    """Refuse names of columns that a table cannot give back.

    Raises
    ------
    ValueError
        If the names in a header would be read as numbers or as a comment, or a name begins as one that is masked.
    """
    if path.suffix.lower() != ".csv":
        return
    names = list(names)
    if all(map(_is_number, names)):
        raise ValueError(f"map names {', '.join(names)} are read as numbers in a table: rename the maps")
    for number, name in enumerate(names):
        if uncell(cell(name)) != name or (number == 0 and name.startswith("#")):
            raise ValueError(f"map name {name!r} is not read back from a table: rename the map")


def write_table(path: Path, maps: dict[str, Floats]) -> None:
    """Write columns with all their digits: .csv with a header, else numbers alone; NaN is written nan.

    Raises
    ------
    ValueError
        As `check_column_names`.
    """
    named = path.suffix.lower() == ".csv"
    check_column_names(path, maps)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, delimiter="," if named else " ", lineterminator="\n")
        if named:
            writer.writerow(map(cell, maps))
        for row in zip(*(values.tolist() for values in maps.values()), strict=True):
            writer.writerow(map(repr, row))


def _is_number(text: str) -> bool:
    try:
        _number(text)
    except ValueError:
        return False
    return True


def _number(text: str) -> float:
    word = text.strip()
    return float("nan") if word.lower() in UNKNOWN else float(word)
