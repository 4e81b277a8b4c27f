"""An experiment's file, planned and not run: what `surfexp check` says of it."""

from __future__ import annotations

from pathlib import Path

from surfexp.commands.request import plan_and_act
from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Plan
from surfexp.lab.registry.folders import experiments


def check_experiment(file: Path) -> str:
    """Return a line on an experiment that can be planned.

    Raises
    ------
    UserError
        At the first mistake, with its line.
    """
    if not file.is_file():
        raise UserError(f"{file}: no such file; surfexp new experiment NAME writes one to start from")
    found = experiments().get(file.stem)
    if found is None or found.resolve() != file.resolve():
        raise UserError(f"{file}: experiments are read from conf/experiment/NAME.yaml of the folder you work in")
    plans: list[Plan] = []
    plan_and_act([f"experiment={file.stem}"], plans.append)
    (plan,) = plans
    counts = {"row": len(plan.leaves), "stage": len(plan.stored), "claim": len(plan.settings.claims)}
    return f"{file}: nothing wrong; " + ", ".join(
        f"{count} {word}{'s' * (count != 1)}" for word, count in counts.items()
    )
