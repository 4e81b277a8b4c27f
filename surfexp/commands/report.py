"""`surfexp report`: the page of finished experiments again, or the verdicts on what was published."""

from __future__ import annotations

from pathlib import Path

import click

from surfexp.commands import choices
from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo


@click.command(**shown("report", "quickstart", "rof_cup --claims > claims.md", cls=click.Command))
@click.argument("experiments", metavar="[EXPERIMENT]...", nargs=-1, shell_complete=choices.finished)
@click.option("--claims", is_flag=True, help="print the verdicts on published claims as Markdown")
@click.option(
    "--beside",
    type=click.Path(path_type=Path),
    help="with --claims: a page, or a folder of pages, whose other experiments are taken over",
)
@click.option(
    "--pages",
    type=click.Path(path_type=Path, file_okay=False),
    help="with --claims: write an index and a page for each chapter into a folder, and print nothing",
)
@click.option("--preface", type=click.Path(path_type=Path), help="with --claims: text for the head of the page")
@results_option
def report(
    experiments: tuple[str, ...],
    claims: bool,
    beside: Path | None,
    pages: Path | None,
    preface: Path | None,
    results: Path,
) -> None:
    """Rewrite the report page of experiments.

    Its place is printed. Without EXPERIMENT it is that of quickstart.
    """
    from surfexp.lab.plan.plan import latest_plan

    plans = {experiment: latest_plan(results, experiment) for experiment in experiments or ["quickstart"]}
    if claims:
        from surfexp.reproduction.index import pages_of
        from surfexp.reproduction.page import reproduction
        from surfexp.reproduction.pages import read_pages, write_pages

        earlier, head = (read_pages(path) if path else "" for path in (beside, preface))
        document = reproduction(plans, results.resolve(), earlier, head)
        if pages is None:
            echo(document)
        else:
            write_pages(pages_of(document), pages)
        return
    from surfexp.commands.results_lock import hold_results
    from surfexp.report.page import write_report

    hold_results(results.resolve())
    for plan in plans.values():
        echo(write_report(plan, results.resolve()) / "report.html")
