"""Tables of results as .csv: columns by name."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from surfexp.commands.certificate import Inputs


def ready_table(table: Path | None, files: Inputs, option: str) -> None:
    """Refuse a table that cannot be written, or would overwrite an input, before anything is computed.

    Raises
    ------
    ValueError
        Naming what is wrong with it.
    """
    if table is None:
        return
    if table.suffix.lower() != ".csv":
        raise ValueError(f"{option} {table} has an unknown format, choose .csv")
    from surfexp.io.replacing import check_writable

    check_writable(table)
    files.refuse_to_overwrite(table)


def write_table_file(table: Path, columns: Mapping[str, Sequence[Any]]) -> None:
    """Write columns under their names."""
    from surfexp.io.csv_cells import cells
    from surfexp.io.replacing import replacing

    with replacing(table) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(cells(row) for row in zip(*columns.values(), strict=True))
