"""Tables of subjects: participants.tsv, or .csv with a header."""

from __future__ import annotations

import csv
from pathlib import Path

from surfexp.io.csv_cells import uncell


def read_subjects(path: Path | str) -> dict[str, list[str]]:
    """Return the columns of a table by their names, as text.

    Parameters
    ----------
    path : path
        Columns are separated by commas, in .tsv by tabs; the first row has their names.

    Returns
    -------
    dict of str to list of str

    Raises
    ------
    ValueError
        If there is no such file or no row, a name is twice, or a row has another length than the first.
    """
    file = Path(path)
    if not file.is_file():
        raise ValueError(f"{path}: no such file, give a table of subjects (.csv or .tsv)")
    lines = file.read_text("utf-8-sig").splitlines()
    rows = [row for row in csv.reader(lines, delimiter="\t" if file.suffix.lower() == ".tsv" else ",") if row]
    if len(rows) < 2:
        raise ValueError(f"{path} has {len(rows)} rows, a header and a row for each map are needed")
    names = [uncell(word.strip()) for word in rows[0]]
    if len(set(names)) < len(names):
        raise ValueError(f"{path}: two columns have the name {next(n for n in names if names.count(n) > 1)!r}")
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(names):
            raise ValueError(f"{path}: row {number} has {len(row)} cells, {len(names)} are needed")
    return {name: [uncell(row[k].strip()) for row in rows[1:]] for k, name in enumerate(names)}
