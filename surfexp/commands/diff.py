"""`surfexp diff`: in what two rows differ, options and numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from surfexp.commands.click_command import results_option, shown

if TYPE_CHECKING:
    from surfexp.records.table import Row


@click.command(**shown("diff", "0c548b1e 26a13223", "0c548b1e 26a13223 --results other/results"))
@click.argument("first", metavar="RUN")
@click.argument("second", metavar="RUN")
@results_option
def diff(first: str, second: str, results: Path) -> int:
    """Compare two rows: the options that differ, and the metrics.

    RUN is the key of a row (the column leaf of metrics.csv and the tag leaf in the dashboard; 8 digits are enough), or
    the id of an MLflow run.
    """
    from rich.table import Table

    from surfexp.commands.console import Console
    from surfexp.records.written_numbers import format_number
    from surfexp.report.row_difference import differing_options, numbers_beside
    from surfexp.report.words import word

    one, other = (_row(results, name) for name in (first, second))
    console = Console(highlight=False, markup=False)
    options = differing_options(one, other)
    table = Table("option", one.leaf.key[:8], other.leaf.key[:8])
    for name, pair in options.items():
        table.add_row(name, *map(word, pair))
    console.print(table if options else "the options are the same")
    numbers = Table("number", one.leaf.key[:8], other.leaf.key[:8], "difference", "ratio")
    for column in numbers.columns[1:]:
        column.justify = "right"
    for name, values in numbers_beside(one, other).items():
        numbers.add_row(name.replace("_", " "), *map(format_number, values))
    console.print(numbers)
    for row in (one, other):
        if row.failure:
            why = f": {row.failure}" if row.failure != row.state else ""
            console.print(f"{row.leaf.key[:8]} {row.state}{why}", soft_wrap=True)
    return 0


def _row(results: Path, name: str) -> Row:
    from surfexp.commands.exporting.selection import find
    from surfexp.lab.errors import UserError
    from surfexp.records.table import rows_of

    plan, key = find(results, name)
    found = [row for row in rows_of(plan, results.resolve()) if row.leaf.key == key]
    if not found:
        raise UserError(f"{name!r} is no row of a table: write the key of one, the column leaf of metrics.csv")
    return found[0]
