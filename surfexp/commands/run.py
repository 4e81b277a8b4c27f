"""`surfexp run` and `surfexp plan`: the arguments are Hydra's."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.table import Table

from surfexp.commands.arguments import check_arguments, usage
from surfexp.workflow.errors import StageFailure, UserError

if TYPE_CHECKING:
    from surfexp.workflow.plan import Plan

LINES_OF_WARNING = 10
ROWS_PRINTED = 200


def command(name: str, arguments: list[str]) -> int:
    """Run (or only plan) what the configuration asks for; 3 where a row did not converge."""
    if {"--help", "-h"} & set(arguments):
        print(usage(name))
        return 0
    check_arguments(arguments)
    from hydra.errors import HydraException
    from omegaconf.errors import OmegaConfBaseException

    from surfexp.report.convergence import UNCONVERGED
    from surfexp.workflow.launch import launch

    doubtful: list[str] = []
    action: Callable[[Plan], None] = _show if name == "plan" else partial(_run, doubtful)
    try:
        launch(arguments, action)
    except (HydraException, OmegaConfBaseException) as error:
        raise UserError(" ".join(str(error).split())) from error
    except OSError as error:
        remedy = "choose another results folder with results=FOLDER"
        raise UserError(f"{error.filename or 'results'}: {error.strerror or error}; {remedy}") from error
    return UNCONVERGED if doubtful else 0


def _run(doubtful: list[str], plan: Plan) -> None:
    """Run a plan and show its results; rows that did not converge are named and added to `doubtful`."""
    from surfexp.commands.execution import run, unfinished
    from surfexp.commands.views import print_tables, wide_console
    from surfexp.report.convergence import unconverged
    from surfexp.report.declared import check_names
    from surfexp.report.table import comparisons, rows_of

    check_names(plan)
    results = Path(plan.settings.results)
    missing = unfinished(plan, results)
    console = wide_console()
    state = f"{len(missing)} to compute" if missing else "nothing to compute"
    console.print(f"{plan.settings.experiment}: {len(plan.leaves)} configurations, {len(plan.stored)} stages, {state}")
    failure = None
    try:
        run(plan)
    except StageFailure as error:
        failure = error
    groups = comparisons(rows_of(plan, results.resolve()))
    print_tables(groups, console, ROWS_PRINTED)
    console.print(f"report     {results / plan.settings.experiment / 'report.html'}", soft_wrap=True)
    folder = "" if plan.settings.results == "results" else f" --results {plan.settings.results}"
    console.print(f"dashboard  surfexp ui{folder}", soft_wrap=True)
    lines = unconverged(plan, results.resolve(), groups)
    doubtful += lines
    warn(lines)
    if failure is not None:
        raise failure


def warn(lines: list[str]) -> None:
    """Name rows that did not converge in the terminal."""
    more = [f"and {len(lines) - LINES_OF_WARNING} more"] if len(lines) > LINES_OF_WARNING else []
    for line in [*lines[:LINES_OF_WARNING], *more]:
        print(f"surfexp: warning: {line}", file=sys.stderr)


def _show(plan: Plan) -> None:
    from surfexp.commands.execution import unfinished
    from surfexp.report.declared import check_names

    check_names(plan)
    results = Path(plan.settings.results)
    missing = Counter(plan.nodes[key].kind for key in unfinished(plan, results))
    unique = Counter(node.kind for node in plan.stored)
    table = Table(
        "stage", "unique", "done", "to compute", title=f"plan of {plan.settings.experiment}", title_justify="left"
    )
    for kind in unique:
        table.add_row(kind, str(unique[kind]), str(unique[kind] - missing[kind]), str(missing[kind]))
    console = Console(highlight=False)
    console.print(table)
    total = sum(unique.values())
    console.print(f"{len(plan.leaves)} configurations: {plan.requested} stages without sharing, {total} with sharing,")
    console.print(f"{sum(missing.values())} to compute, {total - sum(missing.values())} done")
