"""`surfexp open`: the page of an experiment, or the overview of all, in the browser."""

from __future__ import annotations

import webbrowser
from pathlib import Path

from surfexp.commands.parser import Parser
from surfexp.lab.errors import UserError, unknown


def command(name: str, arguments: list[str]) -> int:
    """Open a page that is there and print its place; without a browser the place alone."""
    parser = Parser(f"surfexp {name}", description="The page of an experiment in the browser.")
    parser.add_argument("experiment", nargs="?", help="default: the overview of all")
    parser.add_argument("--results", type=Path, default=Path("results"), help="results folder")
    given = parser.parse_args(arguments)
    pages = {file.parent.name: file for file in given.results.glob("*/report.html")}
    if given.experiment is None:
        page = given.results / "index.html"
        if not page.exists():
            raise UserError(f"no page is in {given.results}; start with: surfexp run")
    elif given.experiment in pages:
        page = pages[given.experiment]
    else:
        raise unknown(f"page in {given.results}", given.experiment, pages)
    print(page)
    webbrowser.open(page.resolve().as_uri())
    return 0
