"""`surfexp list` and `surfexp info`: what there is to choose from."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from rich.console import Console
from rich.table import Table

from surfexp.commands.parser import Parser
from surfexp.lab.errors import UserError, check_known, unknown
from surfexp.lab.registry.catalogue import Catalogue, catalogue
from surfexp.lab.registry.folders import experiments
from surfexp.lab.store.kinds import KINDS

START = "Where to start"
CHAPTERS = {
    1: "Operators (chapter 1)",
    2: "Images on surfaces (chapter 2)",
    3: "Laplace-Beltrami spectra (chapter 3)",
    4: "Nodal counts and signatures (chapter 4)",
    5: "Reeb graphs and skeletons (chapter 5)",
    6: "Embeddings and their distance (chapter 6)",
}
OTHERS = "Others"


def command(name: str, arguments: list[str]) -> int:
    """Print plugins or experiments, the options of one plugin, or what is known of one experiment."""
    parser = Parser(f"surfexp {name}")
    if name == "list":
        parser.add_argument("kind", nargs="?", help=f"one of: {', '.join(KINDS)}, experiment; default: a count of each")
    else:
        parser.add_argument("what", help="KIND/NAME, e.g. solver/primal_dual, or EXPERIMENT")
        parser.add_argument("--results", type=Path, default=Path("results"), help="results folder of the experiment")
    given = parser.parse_args(arguments)
    known = catalogue(Path.cwd())
    console = Console(highlight=False, markup=False)
    for message in known.broken.values():
        Console(stderr=True, highlight=False).print(f"warning: {message}", markup=False, soft_wrap=True)
    if name == "info" and "/" not in given.what:
        from surfexp.commands.experiment_facts import print_facts

        print_facts(given.what, known, given.results, console)
    elif name == "info":
        _info(given.what, known, console)
    elif given.kind in ("experiment", "experiments"):
        _menu(console)
    elif given.kind is None:
        counts = Counter(kind for kind, _ in known.plugins)
        rows = [(kind, f"{counts[kind]} plugins") for kind in known.kinds]
        _rows(console, [*rows, ("experiment", f"{len(experiments())}")])
    elif given.kind in known.kinds:
        _rows(console, [(p.name, p.summary) for (k, _), p in sorted(known.plugins.items()) if k == given.kind])
    else:
        raise unknown("stage kind", given.kind, [*known.kinds, "experiment"])
    return 0


def _menu(console: Console) -> None:
    """Experiments by chapter: where to start, those of the dissertation, the rest, each once."""
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    rows: dict[str, list[tuple[int, str, str]]] = {heading: [] for heading in (START, *CHAPTERS.values(), OTHERS)}
    for name, file in experiments().items():
        known = yaml.load(file.read_bytes(), Loader=loader) or {}  # noqa: S506, one of the two safe ones
        chapter, place = known.get("chapter") or (0, 0)
        heading = START if "start" in known else CHAPTERS.get(chapter, OTHERS)
        rows[heading].append((known.get("start", place), name, str(known.get("title", ""))))
    width = max(len(name) for found in rows.values() for _, name, _ in found)
    for heading, found in rows.items():
        if found:
            console.print(f"\n{heading}")
            _rows(console, [(f"  {name:{width}}", title) for _, name, title in sorted(found)])
    console.print()
    console.print("surfexp run experiment=NAME computes one, surfexp info NAME tells what it is.")


def _rows(console: Console, rows: list[tuple[str, str]]) -> None:
    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*row)
    console.print(table)


def _info(wanted: str, known: Catalogue, console: Console) -> None:
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
