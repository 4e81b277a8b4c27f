"""An experiment by Snakemake's own commands: the rules that a Snakefile includes, and what they need from us.

`python -m surfexp.commands.plain_snakemake PLAN` records a plan that was carried out and writes its pages.
"""

from __future__ import annotations

import json
import os
import re
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from surfexp.commands import results_lock, slurm_jobs
from surfexp.commands.arguments import check_arguments
from surfexp.commands.execution import before_snakemake
from surfexp.commands.finishing import finish, is_finished
from surfexp.commands.request import plan_and_act
from surfexp.lab import running
from surfexp.lab.errors import UserError
from surfexp.lab.plan.kinds_of_plans import load_own_kinds
from surfexp.lab.plan.plan import Plan, read_plan

SNAKEFILE = str(Path(__file__).with_name("workflow.smk"))
STAGES = str(Path(running.__file__).with_name("rules.smk"))


def planned(config: Mapping[str, Any], workflow: Any) -> Path:
    """Plan what Snakemake's configuration asks for, and clear away what is damaged or half made of it.

    Parameters
    ----------
    config : mapping
        Snakemake's: `experiment=NAME`, options such as `solver.tolerance`, nested or by dotted names; or `plan`, the file of
        a plan.
    workflow : snakemake.workflow.Workflow

    Returns
    -------
    Path
        The file of the plan. In a job that Snakemake started nothing is cleared away, for others are at work beside it.

    Raises
    ------
    UserError
        If the configuration has a mistake or asks for a search.
    """
    if "plan" in config:
        path = Path(config["plan"]).resolve()
        plan = read_plan(path)
    else:
        plan = _plan_of(list(words_of(config)))
        path = plan.write(Path(plan.settings.results).resolve())
    if workflow.is_main_process:
        before_snakemake(plan, path.parent.parent)
        # Snakemake compares small inputs by content, with its own last report: a new word says that the page is of another plan
        page, asked = path.parent.parent / plan.settings.experiment / "report.html", path.with_suffix(".asked")
        finished = page.exists() and is_finished(path, plan)
        if not asked.exists() or (page.exists() and not finished):
            asked.write_text(str(time.time_ns()))
        if finished:
            os.utime(asked, (0, 0))
    return path


def _plan_of(arguments: list[str]) -> Plan:
    check_arguments(arguments)
    kept, plans = sys.argv, list[Plan]()
    try:
        plan_and_act(arguments, plans.append)
    finally:
        sys.argv = kept  # which a sweep of Hydra sets
    if len(plans) != 1:
        raise UserError("Snakemake runs one plan; a search is run by surfexp run")
    return plans[0]


def words_of(config: Mapping[str, Any], above: str = "") -> Iterator[str]:
    """Write a configuration of Snakemake as the words of `surfexp run`.

    Examples
    --------
    >>> list(words_of({"experiment": "rof_cup", "model": {"weight": 0.5}, "figures": []}))
    ['experiment=rof_cup', 'model.weight=0.5', 'figures=[]']
    >>> list(words_of({"surface": {"name": "icosphere", "levels": 3}}))
    ['surface=icosphere', 'surface.levels=3']
    """
    for name, value in config.items():
        if isinstance(value, Mapping) and not above and "name" in value:
            yield f"{name}={value['name']}"
            yield from words_of({key: item for key, item in value.items() if key != "name"}, f"{name}.")
        elif isinstance(value, Mapping):
            yield from words_of(value, f"{above}{name}.")
        else:
            yield f"{above}{name}={value if isinstance(value, str) else _written(value)}"


def _written(value: Any) -> str:
    """A value as Hydra reads it, whose keys stand without quotes and to whom a backslash is one, but before a quotation mark."""
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{key}: {_written(item)}' for key, item in value.items())}}}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_written, value))}]"
    if isinstance(value, str):
        doubled = re.sub(r'(\\+)(?="|$)', r"\1\1", value).replace('"', '\\"')
        return f'"{doubled}"'
    return json.dumps(value)


def start(path: Path, workflow: Any) -> None:
    """Take the results folder for this process; refuse to start where that is taken, or where Slurm is not that shall be used."""
    if getattr(workflow.executor_plugin, "name", "").rpartition("_")[2] == "slurm":
        slurm_jobs.check_slurm("with the executor slurm")
    results_lock.hold_results(path.parent.parent)


def record(path: Path) -> None:
    """Record a plan that has ended and write its pages; nothing when `surfexp run` drives it and does so itself."""
    if not os.environ.get(results_lock.HELD):
        plan = read_plan(path)
        load_own_kinds(plan)
        finish(path, plan)


if __name__ == "__main__":
    record(Path(sys.argv[1]))
