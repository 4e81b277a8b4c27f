"""`surfexp list` and `surfexp info`: what there is to choose from."""

from __future__ import annotations

import argparse
from collections import Counter
from importlib.metadata import entry_points
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import yaml
from pydantic.fields import FieldInfo
from rich.console import Console
from rich.table import Table

from surfexp.workflow import registry
from surfexp.workflow.errors import UserError, unknown
from surfexp.workflow.kinds import KINDS


def command(name: str, arguments: list[str]) -> int:
    """Print plugins or experiments, or the options of one plugin."""
    parser = argparse.ArgumentParser(f"surfexp {name}")
    if name == "list":
        parser.add_argument("kind", nargs="?", help=f"one of: {', '.join(KINDS)}, experiment; default: a count of each")
    else:
        parser.add_argument("plugin", help="KIND/NAME, e.g. solver/primal_dual")
    given = parser.parse_args(arguments)
    registry.load_all(Path.cwd())
    console = Console(highlight=False)
    for message in registry.BROKEN.values():
        Console(stderr=True, highlight=False).print(f"warning: {message}", markup=False, soft_wrap=True)
    if name == "info":
        _info(given.plugin, console)
    elif given.kind in ("experiment", "experiments"):
        _rows(console, [(name, _title(file)) for name, file in experiments().items()])
    elif given.kind is None:
        counts = Counter(kind for kind, _ in registry.PLUGINS)
        _rows(
            console, [(kind, f"{counts[kind]} plugins") for kind in KINDS] + [("experiment", f"{len(experiments())}")]
        )
    elif given.kind in KINDS:
        _rows(console, [(p.name, p.summary) for (k, _), p in sorted(registry.PLUGINS.items()) if k == given.kind])
    else:
        raise unknown("stage kind", given.kind, [*KINDS, "experiment"])
    return 0


def experiments() -> dict[str, Path]:
    """Experiment name to YAML file, of the package, of installed plugin packages and of the working folder."""
    installed = {point.module.split(".")[0] for point in entry_points(group="surfexp.plugins")}
    others = [registry.package_folder(f"{name}.conf") for name in sorted(installed) if find_spec(f"{name}.conf")]
    folders = (registry.package_folder("surfexp.conf"), *others, Path("conf"))
    return {file.stem: file for folder in folders for file in sorted((folder / "experiment").glob("*.yaml"))}


def _title(file: Path) -> str:
    return str((yaml.safe_load(file.read_text()) or {}).get("title", ""))


def _rows(console: Console, rows: list[tuple[str, str]]) -> None:
    table = Table.grid(padding=(0, 2))
    for row in rows:
        table.add_row(*row)
    console.print(table)


def _info(wanted: str, console: Console) -> None:
    kind, _, name = wanted.partition("/")
    if not name:
        raise UserError(f"plugin {wanted!r}: write it as KIND/NAME, e.g. solver/primal_dual")
    method = registry.plugin(kind, name)
    console.print(f"{kind}/{name}: {method.summary}")
    for role, item in method.inputs.items():
        allowed = f" ({', '.join(method.accepts[item.kind])})" if item.kind in method.accepts else ""
        console.print(
            f"  input {role}: {item.kind}{'' if item.shape == 'one' else f' ({item.shape})'}{allowed}", markup=False
        )
    table = Table("option", "default", "values", "meaning")
    for option, field in method.options.model_fields.items():
        default = "required" if field.is_required() else repr(field.get_default(call_default_factory=True))
        table.add_row(option, default, domain(field), field.description or "")
    console.print(table if method.options.model_fields else "  no options")
    console.print(f"  {method.file}", soft_wrap=True)


def domain(field: FieldInfo) -> str:
    """The values that an option takes: its choices, or its type and bounds."""
    annotation: Any = field.annotation
    text = getattr(annotation, "__name__", None) if isinstance(annotation, type) else None
    text = text or str(annotation).replace("typing.", "").replace("pathlib.", "").replace("Literal", "one of ")
    signs = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<", "min_length": "length ≥", "max_length": "length ≤"}
    bounds = [
        f"{sign} {getattr(rule, name)}"
        for rule in field.metadata
        for name, sign in signs.items()
        if hasattr(rule, name)
    ]
    return ", ".join([text, *bounds])
