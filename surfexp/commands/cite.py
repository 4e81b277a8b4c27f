"""`surfexp cite`: what to cite for an experiment."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import click

from surfexp import __version__
from surfexp.commands import choices
from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError


@click.command(**shown("cite", "quickstart", "quickstart rof_cup > references.bib", cls=click.Command))
@click.argument("experiments", metavar="EXPERIMENT...", nargs=-1, required=True, shell_complete=choices.experiment)
@results_option
def cite(experiments: tuple[str, ...], results: Path) -> None:
    """Print what to cite for experiments, as BibTeX.

    That is what their last plans used, or what their files name.
    """
    from surfexp.report.citation import bibliography

    used = {plugin: None for experiment in experiments for plugin in plugins_of(experiment, results)}
    echo(bibliography(used, __version__), nl=False)


def plugins_of(experiment: str, results: Path) -> list[str]:
    """Return the plugins of an experiment as KIND/NAME: those of its last plan, or those that its file names."""
    from surfexp.lab.experiment.experiment_files import methods_named, read_experiment
    from surfexp.lab.plan.plan import latest_plan
    from surfexp.lab.registry.catalogue import catalogue

    with suppress(UserError):
        return sorted({f"{node.kind}/{node.plugin}" for node in latest_plan(results, experiment).nodes.values()})
    named = methods_named(read_experiment(experiment), catalogue(Path.cwd()).kinds)
    return [f"{kind}/{method}" for kind, methods in named.items() for method in methods]
