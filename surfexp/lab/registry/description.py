"""Plugins described as a person or Hydra asks for them, once they are loaded."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from surfexp.lab.registry import registry
from surfexp.lab.registry.described import Described
from surfexp.lab.registry.loading import guarded, loaders
from surfexp.lab.store.kinds import KINDS

LONGEST_REASON = 300
PLAIN = (bool, int, float, str, list, dict, type(None))


def describe_all(working_folder: Path, faults: Mapping[str, str], tell: Callable[[str], None]) -> dict[str, Any]:
    """Load all plugins but those with known faults, telling the name of each file before, and describe them."""
    for file, load in loaders(working_folder).items():
        if file in faults:
            registry.BROKEN[Path(file)] = faults[file]
        else:
            tell(file)
            guarded(file, load)
    plugins = []
    for method in registry.PLUGINS.values():
        try:
            plugins.append(asdict(_described(method)))
        except Exception as error:  # of a default that cannot be shown, or whatever an annotation does
            registry.BROKEN[method.file] = f"plugin file {method.file}: {method.name} cannot be described ({error})"
    kinds = [(kind.name, kind.path, kind.stored) for kind in KINDS.values()]
    certified = [kind.name for kind in KINDS.values() if "converged" in getattr(kind.result, "METRICS", {})]
    broken = {str(file): brief(text) for file, text in registry.BROKEN.items()}
    return {"plugins": plugins, "kinds": kinds, "broken": broken, "certified": certified}


def _described(method: Any) -> Described:
    fields = method.options.model_fields
    defaults = {name: "???" if field.is_required() else field.get_default() for name, field in fields.items()}
    defaults = {name: list(value) if isinstance(value, tuple) else value for name, value in defaults.items()}
    plain = {name: value if isinstance(value, PLAIN) else str(value) for name, value in defaults.items()}
    shown = {
        name: "required" if field.is_required() else repr(field.get_default(call_default_factory=True))
        for name, field in fields.items()
    }
    rows = [[name, shown[name], domain(field), field.description or ""] for name, field in fields.items()]
    inputs = {role: [item.kind, item.shape] for role, item in method.inputs.items()}
    accepts = {kind: list(names) for kind, names in method.accepts.items()}
    return Described(method.kind, method.name, str(method.file), method.summary, inputs, accepts, rows, plain)


def domain(field: Any) -> str:
    """The values that an option (a field of pydantic) takes: its choices, or its type and bounds."""
    annotation: Any = field.annotation
    text = getattr(annotation, "__name__", None) if isinstance(annotation, type) else None
    text = text or str(annotation).replace("typing.", "").replace("pathlib.", "").replace(
        "collections.abc.Sequence", "list"
    ).replace("collections.abc.Mapping", "dict").replace("Literal", "one of ")
    signs = {"ge": "≥", "gt": ">", "le": "≤", "lt": "<", "min_length": "length ≥", "max_length": "length ≤"}
    bounds = [
        f"{sign} {getattr(rule, name)}"
        for rule in field.metadata
        for name, sign in signs.items()
        if hasattr(rule, name)
    ]
    return ", ".join([text, *bounds])


def brief(text: str) -> str:
    """Return a text of any length on one line that a person reads to its end."""
    line = " ".join(text.split())
    return line if len(line) <= LONGEST_REASON else f"{line[: LONGEST_REASON - 4]} ..."
