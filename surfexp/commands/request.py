"""A request of `surfexp run` or `surfexp plan`, from its words to its tables."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rich.table import Table

from surfexp.commands.arguments import check_arguments
from surfexp.commands.console import Console
from surfexp.commands.error_line import lacking
from surfexp.commands.searching import is_search, joined, repeatable
from surfexp.commands.several_experiments import apart, each
from surfexp.commands.terminal import counted, echo
from surfexp.lab.errors import StageFailure, UserError
from surfexp.lab.experiment.experiment_files import check_files, located
from surfexp.lab.plan.remembered_plans import place, remember, remembered

if TYPE_CHECKING:
    from surfexp.lab.plan.plan import Plan

LINES_OF_WARNING = 10
ROWS_PRINTED = 200


def carried_out(name: str, arguments: list[str]) -> int:
    """Run (or only plan) what the configuration asks for; 3 where a row did not converge."""
    check_arguments(arguments)
    return each(partial(_one_experiment, name), apart(arguments), _check)


class _Enough(Exception):
    """What a search asks for after its first plan depends on results that are not there."""


def _only_planned(action: Callable[[Plan], None]) -> Callable[[Plan], None]:
    """Return an action that ends a search after its first plan."""

    def act(plan: Plan) -> None:
        action(plan)
        if plan.settings.objective is not None:
            raise _Enough

    return act


def _check(arguments: list[str]) -> None:
    """Plan a request and do nothing; flags would have Hydra answer twice, and what the system lacks is told by the run."""
    if not any(text.startswith("-") for text in arguments):
        with suppress(OSError):
            plan_and_act(arguments, _only_planned(lambda plan: None))


def _one_experiment(name: str, arguments: list[str]) -> int:
    arguments = repeatable(arguments)
    doubtful: list[str] = []
    search = name == "run" and is_search(arguments)
    action: Callable[[Plan], None] = partial(_trials if search else _run, doubtful, arguments)
    try:
        plans = plan_and_act(arguments, _only_planned(_show) if name == "plan" else action)
        if search and plans:
            _tell(plans[-1], doubtful, arguments)
    except OSError as error:
        if lacking(error):
            raise
        remedy = "choose another results folder with results=FOLDER"
        raise UserError(f"{error.filename or 'results'}: {error.strerror or error}; {remedy}") from error
    from surfexp.report.convergence import UNCONVERGED

    return UNCONVERGED if doubtful else 0


def plan_and_act(arguments: list[str], action: Callable[[Plan], None]) -> list[Plan]:
    """Act on the plan of a request, or on each of a search with those before it in it; return them.

    A plan that was made before is not made again, and its names are not checked again.
    """
    kept_at = place(arguments)
    if (known := remembered(kept_at)) is not None:
        with suppress(_Enough):
            action(known)
        return [known]
    check_files(arguments)
    from hydra.errors import HydraException
    from omegaconf.errors import OmegaConfBaseException

    from surfexp.lab.composition.launch import launch
    from surfexp.lab.store.kinds import KINDS
    from surfexp.report.combination import check_combinations, leave_out_figures
    from surfexp.report.declared import check_names, leave_out_columns

    plans: list[Plan] = []
    named = {word.lstrip("+").partition("=")[0] for word in arguments}

    def check_and_act(plan: Plan) -> None:
        replaced = [] if "columns" in named else sorted(named & set(KINDS))
        left_out = leave_out_columns(plan, replaced)
        check_names(plan)
        check_combinations(plan)
        if left_out:
            echo(f"surfexp: columns left out, for no row has them: {', '.join(left_out)}", err=True)
        for line in [*leave_out_figures(plan), *_unread(plan)]:
            echo(f"surfexp: {line}", err=True)
        # a sweeper that searches asks for one plan after the other: its trials are rows of one experiment
        plans.append(joined(plans[-1], plan) if plans and plan.settings.objective else plan)
        action(plans[-1])

    try:
        launch(arguments, check_and_act)
    except _Enough:
        return plans
    except (HydraException, OmegaConfBaseException) as error:
        raise UserError(located(" ".join(str(error).split()), arguments)) from error
    except UserError as error:
        raise UserError(located(str(error), arguments)) from error
    if len(plans) == 1 and plans[0].settings.objective is None:  # a sweeper may ask for one plan after the other
        remember(kept_at, plans[0])
    return plans


def _unread(plan: Plan) -> list[str]:
    """Say which files are in no key, since their options are text."""
    from surfexp.lab.registry.option_files import files_as_text

    nodes = reversed(plan.nodes.values())
    found = {
        f"{node.kind}/{node.plugin}: {option}": path
        for node in nodes
        for option, path in files_as_text(node.options, node.files).items()
    }
    why = "the option is text, so an edit of the file is not seen; annotate it Path"
    return [f"{option} names the file {path!r}, but {why}" for option, path in found.items()]


def _trials(doubtful: list[str], arguments: list[str], plan: Plan) -> None:
    """Run what is new of a search and say how it stands."""
    from surfexp.commands.execution import run
    from surfexp.records.table import rows_of
    from surfexp.report.search import search_of

    run(plan, arguments)
    command = shlex.join(["surfexp", "run", *arguments])
    found = search_of(rows_of(plan, Path(plan.settings.results)), plan.settings.objective, command)
    if found is not None:
        echo(found.sentence)


def _run(doubtful: list[str], arguments: list[str], plan: Plan) -> None:
    """Run a plan and show its results; rows that did not converge are named and added to `doubtful`."""
    from surfexp.commands.execution import run
    from surfexp.commands.unfinished_stages import unfinished
    from surfexp.commands.views import wide_console

    results = Path(plan.settings.results)
    missing = unfinished(plan, results)
    console = wide_console()
    state = f"{len(missing)} to compute" if missing else "nothing to compute"
    rows, stages = counted(len(plan.leaves), "configuration"), counted(len(plan.stored), "stage")
    console.print(f"{plan.settings.experiment}: {rows}, {stages}, {state}")
    failure = None
    try:
        run(plan, arguments)
    except StageFailure as error:
        failure = error
    _tell(plan, doubtful, arguments)
    if failure is not None:
        raise failure


def _tell(plan: Plan, doubtful: list[str], arguments: list[str]) -> None:
    """Print the tables of a plan that was run with these arguments, its verdicts, and where its pages are."""
    from surfexp.commands.last_screen import print_last_screen
    from surfexp.commands.verdict_lines import print_verdicts, verdicts_of
    from surfexp.commands.views import print_tables, wide_console
    from surfexp.records.comparison import comparisons
    from surfexp.records.table import rows_of
    from surfexp.report.convergence import unconverged
    from surfexp.report.search import search_of

    results, console = Path(plan.settings.results), wide_console()
    rows = rows_of(plan, results.resolve())
    groups = comparisons(rows)
    name, tail = plan.settings.experiment, []
    if search := search_of(rows, plan.settings.objective, shlex.join(["surfexp", "run", *arguments])):
        tail += [f"search     {search.sentence}", f"again      {search.command}"]
    page = results / name / "report.html"
    folder = "" if plan.settings.results == "results" else f" --results {shlex.quote(plan.settings.results)}"
    tail.append(f"report     {page if page.exists() else 'not written'}")
    dashboard = dashboard_line(results, folder)
    lines = unconverged(plan, results.resolve(), groups)
    doubtful += lines
    if console.is_terminal:
        tail.append(f"all rows   {results / name / 'metrics.csv'}, surfexp table {name}{folder}")
        print_last_screen(groups, verdicts_of(plan, rows), lines, [*tail, dashboard], console)
        return
    print_tables(groups, console, ROWS_PRINTED)
    print_verdicts(plan, rows, console)
    for text in [*tail, dashboard]:
        console.print(text, soft_wrap=True, markup=False)
    warn(lines)


def warn(lines: list[str]) -> None:
    """Name rows that did not converge in the terminal."""
    more = [f"and {len(lines) - LINES_OF_WARNING} more"] if len(lines) > LINES_OF_WARNING else []
    for line in [*lines[:LINES_OF_WARNING], *more]:
        echo(f"surfexp: warning: {line}", err=True)


def _show(plan: Plan) -> None:
    from surfexp.commands.unfinished_stages import unfinished

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
    rows = counted(len(plan.leaves), "configuration")
    console.print(f"{rows}: {counted(plan.requested, 'stage')} without sharing, {total} with sharing,")
    console.print(f"{sum(missing.values())} to compute, {total - sum(missing.values())} done")


def dashboard_line(results: Path, folder: str) -> str:
    """Say how the dashboard is opened, where runs could be recorded."""
    return f"dashboard  surfexp ui{folder}" if (results / "mlflow.db").is_file() else "dashboard  not written"
