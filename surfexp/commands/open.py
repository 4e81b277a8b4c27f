"""`surfexp open`: the page of an experiment, or the overview of all, in the browser."""

from __future__ import annotations

import webbrowser
from pathlib import Path

import click

from surfexp.commands import choices
from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError, unknown


@click.command(**shown("open", "", "quickstart", cls=click.Command))
@click.argument("experiment", required=False, shell_complete=choices.finished)
@results_option
def open_page(experiment: str | None, results: Path) -> None:
    """Open the page of an experiment, or the overview of all, in the browser.

    Its place is printed too, alone where there is no browser.
    """
    pages = {file.parent.name: file for file in results.glob("*/report.html")}
    if experiment is None:
        page = results / "index.html"
        if not page.exists():
            raise UserError(f"no page is in {results}; start with: surfexp run")
    elif experiment in pages:
        page = pages[experiment]
    else:
        raise unknown(f"page in {results}", experiment, pages)
    echo(page)
    webbrowser.open(page.resolve().as_uri())
