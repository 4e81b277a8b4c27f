"""What has to be there before Snakemake submits jobs elsewhere, and what was said where a job was not taken."""

from __future__ import annotations

import re
from collections.abc import Mapping
from importlib.util import find_spec
from typing import Any

from surfexp.commands import slurm_jobs
from surfexp.lab.errors import UserError

WITH_SNAKEMAKE = ("local", "dryrun", "touch", "surfexp")
# how Snakemake itself begins a line of its log
OWN_LINES = re.compile(r"\s|\[|rule |localrule |group job |checkpoint |Select jobs|Execute |Job stats|Building DAG")
FAILED = re.compile(r"\s*(message: )?Error in (group|rule)")


def check_executor(profile: str, settings: Mapping[str, Any]) -> None:
    """Refuse a profile whose executor is not installed, or whose submission cannot work here.

    Parameters
    ----------
    profile : str
        As it was given, for the message.
    settings : dict
        What the profile sets.

    Raises
    ------
    UserError
        With what to install.
    """
    executor = str(settings.get("executor", "local"))
    if executor not in WITH_SNAKEMAKE and find_spec(f"snakemake_executor_plugin_{executor.replace('-', '_')}") is None:
        raise UserError(
            f"profile {profile} takes Snakemake's executor {executor}, which is not installed: "
            f"pip install snakemake-executor-plugin-{executor}"
        )
    if executor == "slurm":
        slurm_jobs.check_slurm(profile)


def said_at_submission(log: str) -> str:
    """Return the last line that a command of submission printed before the first job failed, "" where it printed none.

    Parameters
    ----------
    log : str
        What Snakemake wrote.
    """
    lines = log.splitlines()
    failed = next((number for number, line in enumerate(lines) if FAILED.match(line)), 0)
    before = reversed(lines[max(0, failed - 3) : failed])
    return next((line for line in before if line.strip() and not OWN_LINES.match(line)), "")
