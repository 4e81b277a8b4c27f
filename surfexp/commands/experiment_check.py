"""An experiment's file, planned and not run: what `surfexp check` says of it."""

from __future__ import annotations

from pathlib import Path

from surfexp.commands.request import plan_and_act
from surfexp.commands.terminal import counted
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
    found, words = experiments().get(file.stem), list[str]()
    if found is None or found.resolve() != file.resolve():
        if file.resolve().parent.name != "experiment":
            raise UserError(
                f"{file}: experiments are read from a folder conf/experiment, of yours or of a plugin package"
            )
        words = ["--config-dir", str(file.resolve().parent.parent)]
    plans: list[Plan] = []
    try:
        plan_and_act([*words, f"experiment={file.stem}"], plans.append)
    except UserError as error:
        package = next((one for one in file.resolve().parents if (one / "pyproject.toml").exists()), None)
        if not words or package is None or " plugin " not in str(error):
            raise
        raise UserError(
            f"{error}; plugins of a package are known once it is installed: pip install {package}"
        ) from None
    (plan,) = plans
    counts = {"row": len(plan.leaves), "stage": len(plan.stored), "claim": len(plan.settings.claims)}
    return f"{file}: nothing wrong; " + ", ".join(counted(count, word) for word, count in counts.items())
