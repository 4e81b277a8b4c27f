"""Tables of subjects: participants.tsv, or .csv with a header."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from surfexp.io.csv_cells import separator_of, uncell
from surfexp.io.entrance import reading


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
    """Return the row of a table for each map, by the first column whose words stand in the names of the maps.

    A word stands in a name where no letter or digit is beside it: "sub-1" in "sub-1.thickness.mgh", not in "sub-12.mgh".

    Parameters
    ----------
    columns : dict of str to (s,) sequence of str
        As `read_subjects` returns them.
    maps : (k,) sequence of str
        Paths of files, or names of maps.

    Returns
    -------
    tuple of str and list of int, optional
        The column, and a row for each map; None where no column names any map.

    Raises
    ------
    ValueError
        If a column names most of the maps but not all, or several alike.

    Examples
    --------
    >>> rows_of_maps({"id": ["a", "b", "c"]}, ["c.mgh", "a.mgh"])
    ('id', [2, 0])
    """
    best: tuple[str, list[list[int]]] | None = None
    for column, words in columns.items():
        patterns = [re.compile(rf"(?<![^\W_]){re.escape(word)}(?![^\W_])") if word else None for word in words]
        found = [[row for row, one in enumerate(patterns) if one and one.search(name)] for name in maps]
        rows = [fitting[0] for fitting in found if len(fitting) == 1]
        if len(rows) == len(set(rows)) == len(maps):
            return column, rows
        if best is None and 2 * len(set(rows)) > len(maps):
            best = column, found
    if best is not None:
        column, found = best
        taken: set[int] = set()
        for name, fitting in zip(maps, found, strict=True):
            if len(fitting) != 1 or fitting[0] in taken:
                many = f"{len(fitting)} rows" if len(fitting) != 1 else "a row that another map has too"
                raise ValueError(f"{name} has {many} by column {column!r}, one of its own is needed")
            taken.add(fitting[0])
    return None
