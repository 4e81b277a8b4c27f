"""`surfexp table`, `surfexp report` and `surfexp ui`: finished results again."""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from surfexp.commands.parser import Parser
from surfexp.commands.verdict_lines import print_verdicts
from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Plan, latest_plan
from surfexp.records.table import Comparison, Row, comparisons, format_number, rows_of, short_name, to_csv
from surfexp.records.tracking import tracking_uri
from surfexp.report.repeats import Repeats, repeats_of, spread
from surfexp.report.words import word

# a name of a method longer than this is broken over lines
NAME_WIDTH = 12
# of an output that is no terminal: no table is that wide
WIDE = 2000
FORMATS = ("text", "latex", "csv")


def command(name: str, arguments: list[str]) -> int:
    """Print tables, write the report again, or start the dashboard."""
    parser = Parser(f"surfexp {name}")
    parser.add_argument("--results", type=Path, default=Path("results"), help="results folder")
    if name == "ui":
        parser.add_argument("--port", type=int, default=5000, help="port on this machine (loopback only)")
        return _dashboard(parser.parse_args(arguments))
    parser.add_argument("experiment", nargs="*", default=["quickstart"])
    if name == "table":
        parser.add_argument(
            "--format", choices=FORMATS, default="text", help="latex needs booktabs; csv has all digits"
        )
    if name == "report":
        parser.add_argument("--claims", action="store_true", help="print the verdicts on published claims as Markdown")
        parser.add_argument("--beside", type=Path, help="with --claims: a page whose other experiments are taken over")
        parser.add_argument("--preface", type=Path, help="with --claims: text for the head of the page")
    given = parser.parse_args(arguments)
    plans = {experiment: latest_plan(given.results, experiment) for experiment in given.experiment}
    if name == "report" and given.claims:
        from surfexp.reproduction.page import reproduction

        earlier, preface = (path.read_text(encoding="utf-8") if path else "" for path in (given.beside, given.preface))
        print(reproduction(plans, given.results.resolve(), earlier, preface))
        return 0
    for plan in plans.values():
        if name == "table":
            _tables(plan, given.results.resolve(), given.format)
        else:
            from surfexp.report.page import write_report

            print(write_report(plan, given.results.resolve()) / "report.html")
    return 0


def _tables(plan: Plan, results: Path, form: str) -> None:
    rows = rows_of(plan, results)
    if form == "csv":
        print(to_csv(rows), end="")
        return
    groups = comparisons(rows)
    if form == "text":
        print_tables(groups, wide_console())
        print_verdicts(plan, rows, wide_console())
        return
    from surfexp.records.origin import read_origin
    from surfexp.report.declared import declared_by
    from surfexp.report.latex import latex_table

    experiment = plan.settings.experiment
    made_by = read_origin(results / experiment).get("command", f"surfexp run experiment={experiment}")
    for count, group in enumerate(groups, 1):
        group.metrics = declared_by(plan, group.rows)
        print(latex_table(group, f"{experiment}-{count}", made_by))


def wide_console() -> Console:
    """A console for tables: as wide as the terminal, or wide enough for any table when the output is a file."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=WIDE)


def print_tables(groups: Sequence[Comparison], console: Console, limit: int | None = None) -> None:
    """One table a comparison; a row that did not converge is red and says so. Of more than `limit` rows an excerpt.

    Where the terminal is too narrow for a table without a cut number, each row is a block of lines.
    """
    for group in groups:
        console.print(f"\n[bold]{escape(group.title)}[/bold]", soft_wrap=True)
        if repeats := repeats_of(group):
            _print(_repeats_table(repeats), console)
        rows = group.rows if limit is None else group.excerpt(limit)
        _print(_table(group, rows), console)
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
        table.add_row(*values, *(spread(row.metrics.get(name)) for name in repeats.metrics), count)
    return table


def _table(group: Comparison, rows: Sequence[Row]) -> Table:
    table = Table(header_style="bold")
    for name in group.varying:
        table.add_column(escape(short_name(name)), overflow="fold")
    for name in group.metric_names:
        table.add_column(escape(name.replace("_", " ")), justify="right")
    limited = any(row.limited or row.failure for row in group.rows)
    if limited:
        table.add_column("state", style="red", no_wrap=True)
    for row in rows:
        values = [escape(word(row.parameters.get(name, "–"))) for name in group.varying]
        numbers = [format_number(row.metrics.get(name)) for name in group.metric_names]
        state = "failed" if row.failure else "not converged" if row.limited else ""
        table.add_row(*values, *numbers, *([state] if limited else []), style="red" if state else None)
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


def _dashboard(given: argparse.Namespace) -> int:
    database = given.results / "mlflow.db"
    if not database.exists():
        raise UserError(f"no runs are recorded in {given.results}; start with: surfexp run")
    from mlflow.tracking import MlflowClient

    found = MlflowClient(tracking_uri(given.results)).search_experiments(order_by=["last_update_time DESC"])
    shown = next((item.experiment_id for item in found if item.name != "Default"), "0")
    view = "orderByKey=metrics.%60relative_gap%60&orderByAsc=true&searchFilter=tags.current%3D%22true%22"
    address = f"http://127.0.0.1:{given.port}/?workflowType=machine_learning#/experiments/{shown}/runs?{view}"
    print(f"dashboard: {address}   (Ctrl-C ends it)", flush=True)
    server = [sys.executable, "-P", "-m", "mlflow", "server", "--host", "127.0.0.1", "--port", str(given.port)]
    environment = {**os.environ, "MLFLOW_SERVER_ENABLE_JOB_EXECUTION": "false", "MLFLOW_DISABLE_TELEMETRY": "true"}
    arguments = ["--backend-store-uri", tracking_uri(given.results), "--workers", "1"]
    return subprocess.call(  # noqa: S603, this interpreter, a path and a port, no shell
        [*server, *arguments], env=environment
    )
