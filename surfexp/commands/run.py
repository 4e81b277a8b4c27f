"""`surfexp run` and `surfexp plan`: the arguments are Hydra's."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from surfexp.commands.execution import run, unfinished
from surfexp.commands.views import print_tables, wide_console
from surfexp.report.convergence import UNCONVERGED, unconverged
from surfexp.report.declared import check_names
from surfexp.workflow.errors import StageFailure, UserError, unknown
from surfexp.workflow.kinds import KINDS
from surfexp.workflow.launch import launch
from surfexp.workflow.plan import Plan

LINES_OF_WARNING = 10


def command(name: str, arguments: list[str]) -> int:
    """Run (or only plan) what the configuration asks for; 3 where a row did not converge."""
    from hydra.errors import HydraException
    from omegaconf.errors import OmegaConfBaseException

    doubtful: list[str] = []
    action: Callable[[Plan], None] = _show if name == "plan" else partial(_run, doubtful)
    try:
        launch(arguments, action)
    except (HydraException, OmegaConfBaseException) as error:
        raise _explained(error, arguments) from error
    except OSError as error:
        remedy = "choose another results folder with results=FOLDER"
        raise UserError(f"{error.filename or 'results'}: {error.strerror or error}; {remedy}") from error
    return UNCONVERGED if doubtful else 0


def _run(doubtful: list[str], plan: Plan) -> None:
    """Run a plan and show its results; rows that did not converge are named and added to `doubtful`."""
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
    print_tables(plan, results, console)
    console.print(f"report     {results / plan.settings.experiment / 'report.html'}", soft_wrap=True)
    folder = "" if plan.settings.results == "results" else f" --results {plan.settings.results}"
    console.print(f"dashboard  surfexp ui{folder}", soft_wrap=True)
    lines = unconverged(plan, results.resolve())
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


def _explained(error: Any, arguments: list[str]) -> UserError:
    """Turn an error of Hydra or OmegaConf into one line with the nearest valid choice."""
    from surfexp.commands.catalogue import experiments
    from surfexp.workflow.configuration import Settings
    from surfexp.workflow.registry import BROKEN, PLUGINS

    for argument in arguments:
        name, _, value = argument.partition("=")
        key = name.lstrip("+~")
        for name in value.split(",") if key.lstrip("+") in (*KINDS, "experiment") else []:
            choices = experiments() if key == "experiment" else [n for kind, n in PLUGINS if kind == key]
            if name not in choices and "(" not in value:
                broken = next((f" ({message})" for file, message in BROKEN.items() if file.stem == name), "")
                return UserError(f"{unknown(key, name, choices)}{broken}")
    for argument in arguments:
        key = argument.partition("=")[0].lstrip("+~")
        head, _, option = key.partition(".")
        if head not in (*KINDS, *Settings.model_fields, "experiment", "hydra", "hydra/sweeper"):
            return unknown("configuration key", head, [*KINDS, *Settings.model_fields])
        if head in KINDS and option and f"{key}" in str(error).replace("'", ""):
            names = {o for (kind, _), method in PLUGINS.items() if kind == head for o in method.options.model_fields}
            return unknown(f"option of {head}", option, names)
    return UserError(" ".join(str(error).split()))
