"""All plugins by kind and name, described without importing them: the description is renewed when a file changes."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any

from surfexp.lab.registry.contained import contained_description
from surfexp.lab.registry.folders import entry_points_of_plugins, installed_packages, package_folder, plugin_files
from surfexp.lab.registry.installed import installed_state
from surfexp.lab.registry.loading import guarded, loaders
from surfexp.lab.user_cache import Memory

LONGEST_REASON = 300
PLAIN = (bool, int, float, str, list, dict, type(None))
# every state of the code has an entry of its own, and they are large
STATES_KEPT = 8
_memory = Memory("plugins", STATES_KEPT)


@dataclass(frozen=True)
class Described:
    """A plugin as a person or Hydra asks for it.

    `options` are rows (name, default, values, meaning); `defaults` is what Hydra composes, "???" where an option is
    required; `inputs` are kind and shape by role, `accepts` the plugins that may feed a kind.
    """

    kind: str
    name: str
    file: str
    summary: str
    inputs: dict[str, list[str]]
    accepts: dict[str, list[str]]
    options: list[list[str]]
    defaults: dict[str, Any]


@dataclass(frozen=True)
class Catalogue:
    """Plugins by kind and name, the stage kinds in order with their result types, and what could not be loaded by file.

    `certified` are the kinds whose results say whether they converged.
    """

    plugins: dict[tuple[str, str], Described]
    kinds: dict[str, tuple[str, bool]]
    broken: dict[str, str]
    certified: frozenset[str]

    def names(self, kind: str) -> list[str]:
        """Names of the plugins of a kind."""
        return [name for of, name in self.plugins if of == kind]


@cache
def catalogue(working_folder: Path) -> Catalogue:
    """What there is to choose from in a working folder; UserError where two plugins have one name."""
    if (found := remembered(working_folder)) is not None:
        return found
    known = contained_description(working_folder)
    # what failed may work the next time, for another reason than a changed file; what hangs is not waited for again
    if set(known["broken"]) <= set(known.pop("contained")):
        _memory.put(code_state(working_folder), known)
    return _read(known)


@cache
def remembered(working_folder: Path) -> Catalogue | None:
    """The catalogue of a working folder where it is known without loading a plugin, else None."""
    known = _memory.get(code_state(working_folder))
    return _read(known) if known else None


def _read(known: dict[str, Any]) -> Catalogue:
    plugins = {(item["kind"], item["name"]): Described(**item) for item in known["plugins"]}
    kinds = {name: (path, stored) for name, path, stored in known["kinds"]}
    return Catalogue(plugins, kinds, known["broken"], frozenset(known["certified"]))


@cache
def code_state(working_folder: Path) -> str:
    """Digest of the names, sizes and times of all files that plugins are made of, and of what is installed."""
    packages = [Path(__file__).resolve().parents[2], *map(package_folder, installed_packages())]
    files = [*plugin_files(working_folder), *(file for package in packages for file in _python_files(str(package)))]
    facts = [(str(file), stat.st_size, stat.st_mtime_ns) for file in files for stat in [file.stat()]]
    points = sorted(f"{point.name}={point.value}" for point in entry_points_of_plugins())
    return hashlib.sha256(repr((facts, points, installed_state())).encode()).hexdigest()


def _python_files(folder: str) -> Iterator[Path]:
    return (Path(file) for file in sorted(map(str, Path(folder).rglob("*.py"))))


def describe_all(working_folder: Path, faults: Mapping[str, str], tell: Callable[[str], None]) -> dict[str, Any]:
    """Load all plugins but those with known faults, telling the name of each file before, and describe them."""
    from surfexp.lab.registry import registry
    from surfexp.lab.store.kinds import KINDS

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
    text = text or str(annotation).replace("typing.", "").replace("pathlib.", "").replace("Literal", "one of ")
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
