"""`surfexp init`: the files with which plain Snakemake runs an experiment in a folder of one's own."""

from __future__ import annotations

import pkgutil
from importlib.resources import files
from pathlib import Path

import click

from surfexp.commands import choices
from surfexp.commands.click_command import shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError, unknown

CONFIGURATION = "# words of surfexp run, one a line, such as solver: newton or model.smoothness: 0.3\n"
EXECUTOR = "snakemake_executor_plugin_surfexp"


@click.command(**shown("init", "", "rof_cup"))
@click.argument("experiment", default="quickstart", shell_complete=choices.experiment)
def init(experiment: str) -> None:
    """Write the files with which plain snakemake runs an experiment.

    They are a Snakefile, a profile and config.yaml, which names EXPERIMENT. Files that are there stay as they are; another
    Snakefile is refused.
    """
    from surfexp.lab.registry.folders import experiments

    if experiment not in (known := experiments()):
        raise unknown("experiment", experiment, known)
    texts = {
        Path("Snakefile"): template("Snakefile"),
        Path("config.yaml"): f"{CONFIGURATION}experiment: {experiment}\n",
        Path("profiles/default/config.yaml"): template("profile") + _executor(),
    }
    snakefile = Path("Snakefile")
    if snakefile.exists() and snakefile.read_text() != texts[snakefile]:
        raise UserError(f"{snakefile.resolve()} exists and is another one: rename it, or take our rules as a module")
    for file, text in texts.items():
        if file.exists():
            echo(f"kept:    {file}")
            continue
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        echo(f"written: {file}")
    echo("try it:  snakemake -n")
    echo("         snakemake -c2")


def template(name: str) -> str:
    """Return a file that is written, by its name among the templates."""
    return files("surfexp.commands").joinpath("templates", f"{name}.txt").read_text(encoding="utf-8")


def _executor() -> str:
    """The executor with warm processes, where Snakemake finds it: not in an editable installation."""
    if any(module.name == EXECUTOR for module in pkgutil.iter_modules()):
        return "# stages as forks of one process that has imported and compiled what they need\nexecutor: surfexp\n"
    return ""
