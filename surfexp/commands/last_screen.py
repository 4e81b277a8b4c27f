"""How a run ends in a terminal: verdicts and warnings, then as much of its tables as one screen holds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from rich.text import Text

from surfexp.commands.console import Console
from surfexp.commands.verdict_lines import STYLES, statement
from surfexp.commands.views import wrapped
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.records.written_numbers import format_number, short_name
from surfexp.report.metric_remarks import metric_remarks
from surfexp.report.verdict import Verdict
from surfexp.report.words import word

LINES, GAP = 24, 2
# of a claim that fails or a row that did not converge; the rest is counted
NAMED = 2
# rows of a table that is worth its heading
FEWEST_ROWS = 2
# characters beside a title for what its table leaves out
LEFT_OUT = 38
BAD = ("not reproduced", "does not hold", "not computed")


@dataclass(frozen=True)
class Column:
    """A column as it is printed: its heading over lines, its cells, and the side on which they stand."""

    heading: list[str]
    cells: list[str]
    right: bool

    @property
    def width(self) -> int:
        """Characters of its longest word or cell: nothing in it is broken."""
        return max(map(len, [*self.heading, *self.cells]))

    def line(self, text: str) -> str:
        """A heading or a cell, in place."""
        return text.rjust(self.width) if self.right else text.ljust(self.width)


def print_last_screen(
    groups: Sequence[Comparison],
    verdicts: Sequence[Verdict],
    warnings: Sequence[str],
    tail: Sequence[str],
    console: Console,
) -> None:
    """Print the end of a run: at most as many lines as the terminal has, no word or number broken.

    Parameters
    ----------
    groups : sequence of Comparison
    verdicts : sequence of Verdict
    warnings : sequence of str
        A line for each row that did not converge.
    tail : sequence of str
        Where all of it stands; the last lines.
    console : Console
    """
    width = console.width
    unknown = [line for group in groups for line in metric_remarks(group)]
    head = [*_verdict_lines(verdicts, width), *_warning_lines(warnings, "rows", width)]
    head += _warning_lines(unknown, "metrics", width)
    end = [Text(line) for text in tail for line in wrapped(text, width, 11)]
    # one line for the command before it, one for the prompt behind it
    left = max(console.height, LINES) - 2 - len(head) - len(end)
    tables, more = _tables(groups, width, left)
    for line in [*head, *tables, *([Text(f"{more} tables more")] if more else []), *end]:
        console.print(line, soft_wrap=True)


def _verdict_lines(verdicts: Sequence[Verdict], width: int) -> list[Text]:
    counts = Counter(item.verdict for item in verdicts)
    if not counts:
        return []
    lines = [Text(", ".join(f"{counts[name]} {name}" for name in STYLES if counts[name]), "bold")]
    bad = [item for item in verdicts if item.verdict in BAD]
    for item in bad[:NAMED]:
        first, *rest = wrapped(f"{item.verdict}  {statement(item)}", width, 2)
        lines += [Text(line, STYLES[item.verdict]) for line in [first, *rest]]
    return lines + ([Text(f"and {len(bad) - NAMED} claims more")] if len(bad) > NAMED else [])


def _warning_lines(warnings: Sequence[str], what: str, width: int) -> list[Text]:
    lines = [Text(line, "red") for text in warnings[:NAMED] for line in wrapped(text, width, 2)]
    return lines + ([Text(f"and {len(warnings) - NAMED} {what} more", "red")] if len(warnings) > NAMED else [])


def _tables(groups: Sequence[Comparison], width: int, left: int) -> tuple[list[Text], int]:
    """The lines of the tables that fit, and how many do not: the last ones get no place before the first have a few rows."""
    whole = [_columns(group, width) for group in groups]
    heads = [
        _heading_lines(group, columns, said, width) for group, (columns, said, _) in zip(groups, whole, strict=True)
    ]
    rows = [len(group.rows) for group in groups]
    shown, spent = 0, 0
    while shown < len(groups):
        least = len(heads[shown]) + 1 + min(rows[shown], FEWEST_ROWS)
        rest = 1 if shown + 1 < len(groups) else 0
        if spent + least + rest > left:
            break
        spent, shown = spent + least, shown + 1
    spare = left - spent - (1 if shown < len(groups) else 0)
    lines: list[Text] = []
    for place in range(shown):
        count = min(rows[place], FEWEST_ROWS)
        # what the tables behind it need to be whole, or their equal part
        behind = sum(rows[k] - min(rows[k], FEWEST_ROWS) for k in range(place + 1, shown))
        more = min(rows[place] - count, max(spare - behind, spare // (shown - place)))
        spare -= more
        columns, _, dropped = whole[place]
        lines += _printed(groups[place], heads[place], columns, dropped, count + more)
    return lines, len(groups) - shown


def _columns(group: Comparison, width: int) -> tuple[list[Column], list[str], int]:
    """The columns that fit, options before numbers, what is the same in all rows, and how many numbers do not fit."""
    options = {short_name(name): [word(row.parameters.get(name, "–")) for row in group.rows] for name in group.varying}
    numbers = {
        name.replace("_", " "): [format_number(row.number(name)) for row in group.rows] for name in group.metric_names
    }
    said, kept, dropped = [], list[Column](), 0
    if states := _states(group.rows):
        kept.append(Column([""], states, False))
    for number, (name, cells) in enumerate([*options.items(), *numbers.items()]):
        values = {*cells} - {"–"}
        if len(values) < 2 and len(group.rows) > 1 and (len(values) == 0 or number >= len(options) or "–" in cells):
            said += [f"{name} {value}" for value in values]
            continue
        column = Column(_heading(name), cells, number >= len(options))
        if sum(one.width + GAP for one in kept) + column.width > width:
            dropped += column.right
            continue
        kept.append(column)
    if states:
        kept.append(kept.pop(0))
    return kept, said, dropped


def _states(rows: Sequence[Row]) -> list[str]:
    states = [row.state for row in rows]
    return states if any(states) else []


def _heading(name: str) -> list[str]:
    """A heading over lines, of words that are no longer together than its longest one."""
    lines = [""]
    longest = max(map(len, name.split()), default=0)
    for one in name.split():
        together = f"{lines[-1]} {one}".strip()
        if len(together) <= longest:
            lines[-1] = together
        else:
            lines.append(one)
    return lines


def _heading_lines(group: Comparison, columns: Sequence[Column], said: Sequence[str], width: int) -> list[Text]:
    height = max((len(column.heading) for column in columns), default=0)
    padded = [[""] * (height - len(column.heading)) + column.heading for column in columns]
    lines = [
        (" " * GAP).join(c.line(t) for c, t in zip(columns, texts, strict=True)).rstrip()
        for texts in zip(*padded, strict=True)
    ]
    title = wrapped(group.title, width - LEFT_OUT, 2)
    constant = wrapped(f"in all rows that have it: {', '.join(said)}", width, 2) if said else []
    return [*(Text(line, "bold") for line in title), *map(Text, constant), *(Text(line, "bold") for line in lines)]


def _printed(group: Comparison, head: list[Text], columns: Sequence[Column], dropped: int, count: int) -> list[Text]:
    """A table of the first rows; its title says what it leaves out."""
    left_out = [f"{count} of {len(group.rows)} rows"] if count < len(group.rows) else []
    numbers = sum(column.right for column in columns)
    total = numbers + dropped
    left_out += [f"{numbers} of {total} numbers"] if dropped else []
    first = head[0] + Text(f"  ({', '.join(left_out)})" if left_out else "")
    lines = [first, *head[1:]]
    for place in range(count):
        row = group.rows[place]
        text = (" " * GAP).join(column.line(column.cells[place]) for column in columns).rstrip()
        lines.append(Text(text, "red" if row.state else ""))
    return [*lines, Text("")]
