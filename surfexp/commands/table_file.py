"""Tables of results as .csv: columns by name."""

from __future__ import annotations

from pathlib import Path

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
