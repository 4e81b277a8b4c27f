"""Tables of finished results in the terminal."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from rich.markup import escape
from rich.table import Table

from surfexp.commands.console import Console
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row, number_notes
from surfexp.records.written_numbers import format_number, short_name
from surfexp.report.metric_remarks import metric_remarks
from surfexp.report.repeats import Repeats, repeats_of
from surfexp.report.words import word

# a name of a method longer than this is broken over lines
NAME_WIDTH = 12
# of an output that is no terminal: no table is that wide
WIDE = 2000


def wide_console() -> Console:
    """A console for tables: as wide as the terminal, or wide enough for any table when the output is a file."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=WIDE)


def wrapped(text: str, width: int, indent: int) -> list[str]:
    """A text over lines, broken at spaces only, the further lines indented."""
    lines = textwrap.wrap(text, width, subsequent_indent=" " * indent, break_long_words=False, break_on_hyphens=False)
    return lines or [""]


def lines_for(text: str, console: Console, indent: int = 2) -> list[str]:
    """A text as a console shows it: wrapped in a terminal, one line in a file."""
    return wrapped(text, console.width, indent) if console.is_terminal else [text]


def print_tables(groups: Sequence[Comparison], console: Console, limit: int | None = None) -> None:
    """One table a comparison with its notes; a row that did not converge is red and says so. Of more than `limit` rows an excerpt.

    Where the terminal is too narrow for a table without a cut number, each row is a block of lines.
    """
    for group in groups:
        console.print(f"\n[bold]{escape(group.title)}[/bold]", soft_wrap=True)
        if repeats := repeats_of(group):
            _print(_repeats_table(repeats), console)
        rows = group.rows if limit is None else group.excerpt(limit)
        notes = number_notes(rows)
        _print(_table(group, rows, notes), console)
        texts = [*metric_remarks(group), *(f"[{number}] {note}" for note, number in notes.items())]
        for line in (line for text in texts for line in lines_for(text, console, 4)):
            console.print(escape(line), soft_wrap=True)
        if len(rows) < len(group.rows):
            said = "the first ones and the best; metrics.csv beside the report and surfexp table have all"
            console.print(f"{len(rows)} of {len(group.rows)} rows: {said}", soft_wrap=True)


def _print(table: Table, console: Console) -> None:
    if sum(_least_widths(table)) + 3 * len(table.columns) + 1 <= console.width:
        console.print(table)
    else:
        _print_blocks(table, console)


def _repeats_table(repeats: Repeats) -> Table:
    seeds = ", ".join(short_name(name) for name in repeats.seeds)
    table = Table(header_style="bold", title=f"mean ± deviation over {seeds}", title_justify="left", title_style="")
    for name in repeats.columns:
        table.add_column(escape(short_name(name)), overflow="fold")
    for name in [*(name.replace("_", " ") for name in repeats.metrics), "n"]:
        table.add_column(escape(name), justify="right")
    for row in repeats.rows:
        values = [escape(word(row.parameters.get(name, "–"))) for name in repeats.columns]
        count = str(row.count) if row.solved == row.count else f"{row.solved} of {row.count}"
        table.add_row(*values, *(row.shown(name) for name in repeats.metrics), count)
    return table


def _table(group: Comparison, rows: Sequence[Row], notes: dict[str, int]) -> Table:
    table = Table(header_style="bold")
    for name in group.varying:
        table.add_column(escape(short_name(name)), overflow="fold")
    for name in group.metric_names:
        table.add_column(escape(name.replace("_", " ")), justify="right")
    limited = any(row.state for row in group.rows)
    if limited:
        table.add_column("state", style="red", no_wrap=True)
    for row in rows:
        values = [escape(word(row.parameters.get(name, "–"))) for name in group.varying]
        numbers = [format_number(row.number(name)) for name in group.metric_names]
        if marks := [str(notes[note]) for note in notes if note in row.notes]:
            values = [f"{values[0]} \\[{','.join(marks)}]", *values[1:]] if values else values
        table.add_row(*values, *numbers, *([row.state] if limited else []), style="red" if row.state else None)
    return table


def _least_widths(table: Table) -> list[int]:
    """Least width of each column: numbers and the words of headings are never broken, long names are."""
    widths = []
    for column in table.columns:
        words = [word for text in [str(column.header)] for word in text.split()]
        cells = [str(cell) for cell in column.cells]
        whole = cells if column.justify == "right" or column.no_wrap else [cell[:NAME_WIDTH] for cell in cells]
        widths.append(max(map(len, [*words, *whole]), default=0))
    return widths


def _print_blocks(table: Table, console: Console) -> None:
    """Each row as lines: what tells it apart, then its numbers by name."""
    headings = [str(column.header) for column in table.columns]
    width = max(map(len, headings))
    for row, *cells in zip(table.rows, *(column.cells for column in table.columns), strict=True):
        console.print()
        for heading, cell in zip(headings, cells, strict=True):
            if cell not in ("", "–"):
                console.print(f"  {heading:{width}}  {cell}", style=row.style, soft_wrap=True)
