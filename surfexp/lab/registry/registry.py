"""The plugin registry: every method by kind and name."""

from __future__ import annotations

import importlib.util
import inspect
import sys
import traceback
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints

from pydantic import BaseModel, ConfigDict

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.digests import digest
from surfexp.lab.errors import UserError, check_known, unknown
from surfexp.lab.store.kinds import KINDS, kind_of


class Options(BaseModel):
    """Base class of plugin options: unknown names are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


@dataclass(frozen=True)
class Input:
    """One input of a plugin: the kind it asks for, and how it takes results: one, a list, or a dict by label or by member."""

    kind: str
    shape: str


@dataclass(frozen=True)
class Plugin:
    """A registered method."""

    kind: str
    name: str
    function: Callable[..., Any]
    options: type[BaseModel]
    inputs: Mapping[str, Input]
    file: Path
    accepts: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    metrics: Mapping[str, Metric] = field(default_factory=dict)

    @cached_property
    def paths(self) -> frozenset[str]:
        """The options that name files."""
        return frozenset(name for name, item in self.options.model_fields.items() if "Path" in str(item.annotation))

    @property
    def summary(self) -> str:
        """First line of the function's docstring."""
        return (inspect.getdoc(self.function) or "").split("\n", 1)[0]


PLUGINS: dict[tuple[str, str], Plugin] = {}
BROKEN: dict[Path, str] = {}
DESCRIBED: dict[tuple[str, str], Path] = {}
_loaded: set[str] = set()


def register(
    kind: str,
    name: str,
    *,
    accepts: Mapping[str, Iterable[str]] | None = None,
    metrics: Mapping[str, Metric] | None = None,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a function as plugin `name` of stage `kind`.

    Its first argument is annotated with a pydantic model of options; each keyword-only argument is an input, named by
    its role and annotated with the result type of a kind (or a list of it, or a dict of it by label or by `Member`).
    `accepts` restricts, for a kind, which plugins may feed this one; it is checked before anything runs.
    `metrics` declares what the results measure, beside what every result of the kind does (`METRICS` of its class).
    """

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        file = Path(inspect.getfile(function)).resolve()
        known = PLUGINS.get((kind, name))
        if known is not None and known.file != file and known.file.read_bytes() != file.read_bytes():
            raise UserError(f"plugin {kind}/{name} is defined twice: {known.file} and {file}")
        if known is None:
            restrictions = {key: tuple(names) for key, names in (accepts or {}).items()}
            options, inputs = _signature(kind, name, function)
            PLUGINS[kind, name] = Plugin(kind, name, function, options, inputs, file, restrictions, metrics or {})
        return function

    return decorate


def _signature(kind: str, name: str, function: Callable[..., Any]) -> tuple[type[BaseModel], dict[str, Input]]:
    where = f"plugin {kind}/{name}"
    if not (isinstance(name, str) and name.isidentifier()):
        raise UserError(f"{where}: a name is a word of letters, digits and underscores, e.g. 'split_bregman'")
    check_known("stage kind", [kind], KINDS)
    hints = get_type_hints(function)
    parameters = list(inspect.signature(function).parameters.values())
    options = hints.get(parameters[0].name) if parameters else None
    if not (isinstance(options, type) and issubclass(options, BaseModel)):
        raise UserError(f"{where}: its first argument must be annotated with a pydantic model of options")
    clash = set(options.model_fields) & (set(KINDS) | {"name", "inputs"})
    if clash:
        raise UserError(f"{where}: option {min(clash)!r} has the name of a stage kind or of a setting")
    inputs = {}
    for parameter in parameters[1:]:
        hint = hints[parameter.name]
        shapes = {list: "list", dict: "members" if Member in get_args(hint) else "dict"}
        shape = shapes.get(get_origin(hint) or hint, "one")
        try:
            inputs[parameter.name] = Input(kind_of(get_args(hint)[-1] if shape != "one" else hint), shape)
        except KeyError:
            raise UserError(f"{where}: input {parameter.name!r} is annotated {hint}, which is no stage kind") from None
    return options, inputs


def plugin(kind: str, name: str) -> Plugin:
    """Look a plugin up; UserError with the nearest name, or with the file that failed to load."""
    if (kind, name) not in PLUGINS and (kind, name) in DESCRIBED:
        load_file(DESCRIBED[kind, name])
    if (kind, name) not in PLUGINS:
        check_known("stage kind", [kind], KINDS)
        raise unknown_plugin(f"{kind} plugin", kind, name)
    return PLUGINS[kind, name]


def unknown_plugin(thing: str, kind: str, name: str) -> UserError:
    """Say that a plugin does not exist: the nearest name, and the file of that name that failed to load."""
    broken = next((f" ({message})" for file, message in BROKEN.items() if file.stem == name), "")
    return UserError(f"{unknown(thing, name, names_of(kind))}{broken}")


def load_file(file: Path) -> None:
    """Execute one plugin file, once; UserError naming file and line if it fails."""
    file = file.resolve()
    module_name = f"surfexp_plugin_{digest(str(file))}_{file.stem}"
    if str(file) in _loaded:
        return
    _loaded.add(str(file))
    specification = importlib.util.spec_from_file_location(module_name, file)
    assert specification is not None and specification.loader is not None  # noqa: S101, narrows a type
    module = sys.modules[module_name] = importlib.util.module_from_spec(specification)
    try:
        specification.loader.exec_module(module)
    except UserError:
        raise
    except SyntaxError as error:
        raise UserError(f"plugin file {file}, line {error.lineno}: {error.msg}") from error
    except (Exception, SystemExit) as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(file)]
        raise UserError(f"plugin file {file}, line {lines[-1] if lines else '?'}: {error}") from error


def names_of(kind: str) -> list[str]:
    """Names of the plugins of a kind, loaded or not."""
    return list(dict.fromkeys(name for of, name in (*PLUGINS, *DESCRIBED) if of == kind))
