"""`surfexp cite`: what to cite for an experiment, as BibTeX."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from surfexp import __version__
from surfexp.commands.parser import Parser
from surfexp.lab.errors import UserError
from surfexp.lab.experiment.experiment_files import methods_named, read_experiment
from surfexp.lab.plan.plan import latest_plan
from surfexp.lab.registry.catalogue import catalogue
from surfexp.report.citation import bibliography


def command(name: str, arguments: list[str]) -> int:
    """Print the bibliography of experiments: of their last plans, or of what their files name."""
    parser = Parser(f"surfexp {name}", description="What to cite for an experiment, as BibTeX.")
    parser.add_argument("experiment", nargs="+")
    parser.add_argument("--results", type=Path, default=Path("results"), help="results folder")
    given = parser.parse_args(arguments)
    used = {plugin: None for experiment in given.experiment for plugin in plugins_of(experiment, given.results)}
    print(bibliography(used, __version__), end="")
    return 0


def plugins_of(experiment: str, results: Path) -> list[str]:
    """Return the plugins of an experiment as KIND/NAME: those of its last plan, or those that its file names."""
    with suppress(UserError):
        return sorted({f"{node.kind}/{node.plugin}" for node in latest_plan(results, experiment).nodes.values()})
    named = methods_named(read_experiment(experiment), catalogue(Path.cwd()).kinds)
    return [f"{kind}/{method}" for kind, methods in named.items() for method in methods]
