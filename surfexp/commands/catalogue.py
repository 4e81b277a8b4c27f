"""`surfexp list` and `surfexp info`: what there is to choose from."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from surfexp.commands import choices
from surfexp.commands.cited_places import Place, asked_place, experiments_at, stated_at
from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError, check_known, unknown
from surfexp.reproduction.statements import CHAPTERS

if TYPE_CHECKING:
    from surfexp.commands.console import Console
    from surfexp.lab.registry.catalogue import Catalogue

START = "Where to start"
HEADINGS = {chapter: f"{title} (chapter {chapter})" for chapter, title in CHAPTERS.items()}
OTHERS = "Others"


@click.command(**shown("list", "", "solver", "experiment", cls=click.Command))
@click.argument("kind", required=False, shell_complete=choices.kind_or_experiment)
def list_choices(kind: str | None) -> None:
    """List the plugins of a kind, or the experiments.

    Without KIND it is a count of each.
    """
    known, console = _known(), _console()
    if kind in ("experiment", "experiments"):
        _menu(console)
    elif kind is None:
        from surfexp.lab.registry.folders import experiments

        counts = Counter(kind for kind, _ in known.plugins)
        rows = [(kind, f"{counts[kind]} plugins") for kind in known.kinds]
        _rows(console, [*rows, ("experiment", f"{len(experiments())}")])
    elif kind in known.kinds:
        _rows(console, [(p.name, p.summary) for (k, _), p in sorted(known.plugins.items()) if k == kind])
    else:
        raise unknown("stage kind", kind, [*known.kinds, "experiment"])


@click.command(**shown("info", "solver/primal_dual", "quickstart", "figure 2.3", "2.8", cls=click.Command))
@click.argument(
    "what",
    metavar="KIND/NAME|EXPERIMENT|[KIND] NUMBER",
    nargs=-1,
    required=True,
    shell_complete=choices.plugin_or_experiment,
)
@results_option
def info(what: tuple[str, ...], results: Path) -> None:
    """Show the options of a plugin, or the question and cost of an experiment.

    A number such as 2.8, table 3.1 or figure 5.9 is that of the dissertation: the experiments about it are listed.
    """
    asked = " ".join(what)
    known, console = _known(), _console()
    if (place := asked_place(asked)) is not None:
        _experiments_at(place, console)
    elif "/" in asked:
        _info(asked, known, console)
    else:
        from surfexp.commands.experiment_facts import print_facts

        print_facts(asked, known, results, console)


def _experiments_at(place: Place, console: Console) -> None:
    documents, stated = _documents(), stated_at(place)
    for item in stated:
        console.print(f"{item.id}: {item.states}", soft_wrap=True)
        if item.none:
            console.print(f"  No verdict: {item.none}.", soft_wrap=True)
    if stated and not any(item.verdicts or item.ours for item in stated):
        return
    rows = experiments_at(place, documents).items()
    _rows(console, [(name, str(documents[name].get("title", "")), ", ".join(places)) for name, places in rows])
    console.print("\nsurfexp run experiment=NAME computes one, surfexp info NAME tells what it is.", soft_wrap=True)


def _documents() -> dict[str, Any]:
    """Contents of all experiment files by name, read fast; those that cannot be read are named."""
    import yaml

    from surfexp.lab.registry.folders import experiments

    loader, documents = getattr(yaml, "CSafeLoader", yaml.SafeLoader), {}
    for name, file in experiments().items():
        try:
            found = yaml.load(file.read_bytes(), Loader=loader) or {}  # noqa: S506, one of the two safe ones
        except (yaml.YAMLError, UnicodeDecodeError):
            found = None
        if isinstance(found, dict):
            documents[name] = found
        else:
            echo(f"warning: {file} is no experiment and left out; surfexp check {file} says why", err=True)
    return documents


def _console() -> Console:
    from surfexp.commands.console import Console

    return Console(highlight=False, markup=False)


def _known() -> Catalogue:
    """The catalogue of the working folder; files that cannot be read are named."""
    from surfexp.lab.registry.catalogue import catalogue

    known = catalogue(Path.cwd())
    for message in known.broken.values():
        echo(f"warning: {message}", err=True)
    return known


def _menu(console: Console) -> None:
    """Experiments by chapter: where to start, those of the dissertation, the rest, each once."""
    rows: dict[str, list[tuple[int, str, str]]] = {heading: [] for heading in (START, *HEADINGS.values(), OTHERS)}
    for name, known in _documents().items():
        chapter, place = _whole_numbers(known.get("chapter"), 2) or (0, 0)
        start = _whole_numbers([known.get("start")], 1)
        heading = START if start else HEADINGS.get(chapter, OTHERS)
        rows[heading].append((start[0] if start else place, name, str(known.get("title", ""))))
    width = max(len(name) for found in rows.values() for _, name, _ in found)
    for heading, found in rows.items():
        if found:
            console.print(f"\n{heading}")
            _rows(console, [(f"  {name:{width}}", title) for _, name, title in sorted(found)])
    console.print()
    console.print("surfexp run experiment=NAME computes one, surfexp info NAME tells what it is.")


def _whole_numbers(given: Any, count: int) -> tuple[int, ...]:
    """What a file of the user's says, where it is so many whole numbers, else nothing."""
    fit = isinstance(given, list | tuple) and len(given) == count and all(isinstance(one, int) for one in given)
    return tuple(given) if fit else ()


def _rows(console: Console, rows: list[tuple[str, ...]]) -> None:
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*row)
    console.print(table)


def _info(wanted: str, known: Catalogue, console: Console) -> None:
    from rich.table import Table

    kind, _, name = wanted.partition("/")
    check_known("stage kind", [kind], known.kinds)
    if (kind, name) not in known.plugins:
        broken = next((f" ({text})" for file, text in known.broken.items() if Path(file).stem == name), "")
        raise UserError(f"{unknown(f'{kind} plugin', name, known.names(kind))}{broken}")
    method = known.plugins[kind, name]
    console.print(f"{kind}/{name}: {method.summary}")
    for role, (asked, shape) in method.inputs.items():
        allowed = f" ({', '.join(method.accepts[asked])})" if asked in method.accepts else ""
        console.print(f"  input {role}: {asked}{'' if shape == 'one' else f' ({shape})'}{allowed}", markup=False)
    table = Table("option", "default", "values", "meaning")
    for row in method.options:
        table.add_row(*row)
    console.print(table if method.options else "  no options")
    console.print(f"  {method.file}", soft_wrap=True)
