"""`surfexp table`: the tables of finished experiments again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from surfexp.commands import choices
from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo

if TYPE_CHECKING:
    from surfexp.lab.plan.plan import Plan


@click.command(**shown("table", "", "quickstart --format latex", cls=click.Command))
@click.argument("experiments", metavar="[EXPERIMENT]...", nargs=-1, shell_complete=choices.finished)
@click.option(
    "--format",
    "form",
    type=click.Choice(["text", "latex", "csv"]),
    default="text",
    help="latex needs booktabs; csv has all digits",
)
@results_option
def table(experiments: tuple[str, ...], form: str, results: Path) -> None:
    """Print the tables of experiments.

    Without EXPERIMENT they are those of quickstart.
    """
    from surfexp.lab.plan.plan import latest_plan

    for plan in [latest_plan(results, experiment) for experiment in experiments or ["quickstart"]]:
        _print(plan, results.resolve(), form)


def _print(plan: Plan, results: Path, form: str) -> None:
    from surfexp.commands.verdict_lines import print_verdicts
    from surfexp.commands.views import print_tables, wide_console
    from surfexp.records.comparison import comparisons
    from surfexp.records.table import rows_of, to_csv

    rows = rows_of(plan, results)
    if form == "csv":
        echo(to_csv(rows), nl=False)
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
    made_by = read_origin(results, plan).get("command", f"surfexp run experiment={experiment}")
    for count, group in enumerate(groups, 1):
        group.metrics = declared_by(plan, group.rows)
        echo(latex_table(group, f"{experiment}-{count}", made_by))
