"""Tables of subjects: participants.tsv, or .csv with a header."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from functools import cache
from itertools import combinations, takewhile
from pathlib import Path

from surfexp.io.csv_cells import separator_of, uncell
from surfexp.io.entrance import reading

# what BIDS writes where nothing is known, and no path
UNKNOWN = "n/a"


def read_subjects(path: Path | str) -> dict[str, list[str]]:
    """Return the columns of a table by their names, as text.

    Parameters
    ----------
    path : path
        The first row has the names of the columns; they are separated by tabs in .tsv, else by commas, semicolons
        or tabs: what makes most cells of the first rows.

    Returns
    -------
    dict of str to list of str

    Raises
    ------
    ValueError
        If there is no such file or no row, it is no text in UTF-8, a name is twice, or a row has another length than the first.
    """
    file = Path(path)
    if not file.is_file():
        raise ValueError(f"{path}: no such file, give a table of subjects (.csv or .tsv)")
    with reading(path, "cannot be read as a table of subjects"):
        lines = file.read_text("utf-8-sig").splitlines()
    between = "\t" if file.suffix.lower() == ".tsv" else separator_of(lines)
    rows = [row for row in csv.reader(lines, delimiter=between) if row]
    if len(rows) < 2:
        raise ValueError(f"{path} has {len(rows)} rows, a header and a row for each map are needed")
    names = [uncell(word.strip()) for word in rows[0]]
    if len(set(names)) < len(names):
        raise ValueError(f"{path}: two columns have the name {next(n for n in names if names.count(n) > 1)!r}")
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(names):
            raise ValueError(f"{path}: row {number} has {len(row)} cells, {len(names)} are needed")
    return {name: [uncell(row[k].strip()) for row in rows[1:]] for k, name in enumerate(names)}


def rows_of_maps(columns: Mapping[str, Sequence[str]], maps: Sequence[str]) -> tuple[str, list[int]] | None:
    """Return the row of a table for each map, by the column, or the two columns, whose words stand in the names of the maps.

    A word stands in a name where no letter or digit is beside it: "sub-1" in "sub-1.thickness.mgh", not in "sub-12.mgh".
    Folders count where the name of the file has no word of the column, the nearest one first. A word may be a path: its last
    part stands in the name of the file, and of several such rows those count that have the most folders in common with it.

    Parameters
    ----------
    columns : dict of str to (s,) sequence of str
        As `read_subjects` returns them.
    maps : (k,) sequence of str
        Paths of files, or names of maps.

    Returns
    -------
    tuple of str and list of int, optional
        The column, and a row for each map. Whole numbers count where no other column names the maps: an id says more than
        the number of a row. None where no column names any map.

    Raises
    ------
    ValueError
        If a column names half of the maps but not all, or several alike, or two columns, or pairs of them, say different rows.

    Examples
    --------
    >>> rows_of_maps({"id": ["a", "b", "c"]}, ["c.mgh", "a.mgh"])
    ('id', [2, 0])
    >>> rows_of_maps({"id": ["a", "a", "b"], "visit": ["1", "2", "1"]}, ["a_2.mgh", "b_1.mgh", "a_1.mgh"])
    ('id and visit', [1, 2, 0])
    """
    fits = {column: _fitting(words, maps) for column, words in columns.items()}
    alone = {column: rows for column, found in fits.items() if (rows := _one_each(found)) is not None}
    if alone:
        numbers = {column for column, rows in alone.items() if all(columns[column][row].isdigit() for row in rows)}
        return _agreed({column: rows for column, rows in alone.items() if column not in numbers} or alone)
    whole = {column: found for column, found in fits.items() if all(found)}
    together = {}
    for first, second in combinations(whole, 2):
        common = [sorted({*a} & {*b}) for a, b in zip(whole[first], whole[second], strict=True)]
        if (rows := _one_each(common)) is not None:
            together[f"{first} and {second}"] = rows
    if together:
        return _agreed(together)
    for column, found in fits.items():
        named = {columns[column][row].lower() for fitting in found for row in fitting}
        if 2 * len(named) >= len(maps) > 1 and 2 * sum(map(bool, found)) >= len(maps):
            raise ValueError(_misfit(column, found, maps))
    return None


def _agreed(named: Mapping[str, list[int]]) -> tuple[str, list[int]]:
    """The first of several names for rows, if all say the same rows."""
    first = next(iter(named))
    other = next((name for name in named if named[name] != named[first]), None)
    if other is not None:
        raise ValueError(f"columns {first!r} and {other!r} both name the maps, in different orders: leave one out")
    return first, named[first]


def _fitting(words: Sequence[str], maps: Sequence[str]) -> list[list[int]]:
    """The rows whose word stands in the name of each map; of paths those that have the most folders in common with it."""
    paths = [[_standing(part) for part in _parts("" if word == UNKNOWN else word)] for word in words]
    named = cache(lambda part: [row for row, path in enumerate(paths) if path and path[0].search(part)])
    found = []
    for parts in map(_parts, maps):
        rows, rest = next(((rows, parts[k:]) for k, part in enumerate(parts) if (rows := named(part))), ([], []))
        tails = [_common(paths[row], rest) for row in rows]
        found.append([row for row, tail in zip(rows, tails, strict=True) if tail == max(tails)])
    return found


def _parts(path: str) -> list[str]:
    """The name of a file, then its folders, the nearest one first."""
    return [part for part in reversed(path.replace("\\", "/").split("/")) if part]


def _standing(word: str) -> re.Pattern[str]:
    return re.compile(rf"(?<![^\W_]){re.escape(word)}(?![^\W_])", re.IGNORECASE)


def _common(path: Sequence[re.Pattern[str]], parts: Sequence[str]) -> int:
    """How many parts of a path, from its end, stand in those of another one."""
    pairs = zip(path, parts, strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0].search(pair[1]), pairs))


def _one_each(found: Sequence[Sequence[int]]) -> list[int] | None:
    """The row of each map, where each has one of its own."""
    rows = [fitting[0] for fitting in found if len(fitting) == 1]
    return rows if len(rows) == len(set(rows)) == len(found) else None


def _misfit(column: str, found: Sequence[Sequence[int]], maps: Sequence[str]) -> str:
    """What is wrong with the first map that has not a row of its own."""
    earlier = [found[:k] for k in range(len(found))]
    worst = next(k for k, rows in enumerate(found) if len(rows) != 1 or rows in earlier[k])
    many = f"{len(found[worst])} rows" if len(found[worst]) != 1 else "a row that another map has too"
    return f"{maps[worst]} has {many} by column {column!r}, one of its own is needed"
