"""The plugin registry: every method by kind and name."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
import traceback
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, get_type_hints

from pydantic import BaseModel

from surfexp.contract.metric import Metric
from surfexp.lab.digests import digest
from surfexp.lab.errors import UserError, check_known, unknown
from surfexp.lab.registry.folders import module_of
from surfexp.lab.registry.option_files import names_files
from surfexp.lab.registry.signature import Input, options_and_inputs
from surfexp.lab.store.kinds import KINDS


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
    exports: Callable[..., Iterable[tuple[str, Path]]] | None = None
    names: Mapping[str, str] = field(default_factory=dict)
    given: Mapping[str, Any] = field(default_factory=dict)
    stated: str = ""
    line: int = 0

    @cached_property
    def paths(self) -> frozenset[str]:
        """The options that name files: those annotated with a path, or a collection of paths."""
        return frozenset(name for name, item in self.options.model_fields.items() if names_files(item.annotation))

    @cached_property
    def parts(self) -> dict[str, str]:
        """By role, the part of its result that the function takes."""
        return {role: item.part for role, item in self.inputs.items() if item.part}

    @cached_property
    def groups(self) -> dict[str, tuple[type, list[str]]]:
        """By parameter that is a dataclass of results, its class and the roles that fill it."""
        found: dict[str, tuple[type, list[str]]] = {}
        hints = get_type_hints(self.function)
        for role, item in self.inputs.items():
            if item.group:
                found.setdefault(item.group, (hints[item.group], []))[1].append(role)
        return found

    @property
    def summary(self) -> str:
        """What it does in one line: what it was registered with, or the first line of the function's docstring."""
        return self.stated or (inspect.getdoc(self.function) or "").split("\n", 1)[0]

    def __call__(self, options: Mapping[str, Any], **inputs: Any) -> Any:
        """Call the function on checked options, with defaults for those that are not given, and on results by role."""
        named = inputs | dict(self.options(**options))
        for role, part in self.parts.items():
            named[part] = getattr(named.pop(role), part)
        for parameter, (group, roles) in self.groups.items():
            named[parameter] = group(**{role: named.pop(role) for role in roles})
        for parameter, name in self.names.items():
            named[parameter] = named.pop(name)
        return self.function(**named, **self.given)


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
    defaults_of: Callable[..., Any] | Iterable[Callable[..., Any]] = (),
    exports: Callable[..., Iterable[tuple[str, Path]]] | None = None,
    options: Mapping[str, Any] | None = None,
    names: Mapping[str, str] | None = None,
    given: Mapping[str, Any] | None = None,
    summary: str = "",
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a function as plugin `name` of stage `kind`.

    A parameter annotated with the result type of a kind (or a list of it, or a dict of it by label or by `Member`) is an
    input, named by its role; `mesh: TriangleMesh` takes the mesh of the role `surface`, and a dataclass of results its fields.
    Every other parameter is an option:
    `tolerance: Annotated[float, Field(gt=0, description="...")] = 1e-4`. An option without default has the one of the
    parameter of its name in `defaults_of`, the first function that has one, or else is required.
    `accepts` restricts, for a kind, which plugins may feed this one; it is checked before anything runs.
    `metrics` declares what the results measure, beside what every result of the kind does (`METRICS` of its class).
    `options` registers a function or class of the library as it stands: `register("model", "rof", options={"weight":
    Field(gt=0)})(ROF)`. Of its parameters these are options, each with its bounds; types and defaults are those of the
    signature. `names` says what an experiment calls a parameter where the function calls it otherwise: `names={"matrix":
    "distance_matrix"}`. `given` are parameters that the plugin always gives, `given={"method": "k_nearest"}`, and `summary`
    says in one line what it then does, where the function's docstring does not.
    `exports` writes further files when a result is exported: it is called with a folder and with what the function is
    called with, and yields the name of each file, from which that in the export is made, and its path.
    """
    caller = inspect.currentframe()
    assert caller is not None and caller.f_back is not None  # noqa: S101, narrows a type
    file, line = Path(caller.f_back.f_code.co_filename).resolve(), caller.f_back.f_lineno

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        known = PLUGINS.get((kind, name))
        if known is not None and not _same_definition(known, function, file, line):
            places = f"{known.file}, line {known.line} and {file}, line {line}"
            raise UserError(f"plugin {kind}/{name} is defined twice: {places}")
        if known is None:
            where = f"plugin {kind}/{name}"
            if not (isinstance(name, str) and name.isidentifier()):
                raise UserError(f"{where}: a name is a word of letters, digits and underscores, e.g. 'split_bregman'")
            check_known("stage kind", [kind], KINDS)
            sources = (defaults_of,) if callable(defaults_of) else tuple(defaults_of)
            model, inputs = options_and_inputs(where, function, sources, options, names or {}, given or {})
            restrictions = {key: tuple(names) for key, names in (accepts or {}).items()}
            PLUGINS[kind, name] = Plugin(
                kind, name, function, model, inputs, file, restrictions, metrics or {}, exports, names or {},
                given or {}, summary, line,
            )  # fmt: skip
        return function

    return decorate


def _same_definition(known: Plugin, function: Callable[..., Any], file: Path, line: int) -> bool:
    """Whether a definition is the one that is known, of a file that is executed again or of one of the same bytes."""
    same_place = (known.line, known.function.__qualname__) == (line, function.__qualname__)
    return same_place and (known.file == file or known.file.read_bytes() == file.read_bytes())


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
    """Execute one plugin file, once; UserError naming file and line if it fails.

    One of an installed package is imported by its name, so that it takes part in its package; any other stands alone.
    """
    file = file.resolve()
    if str(file) in _loaded:
        return
    _loaded.add(str(file))
    try:
        if module := module_of(file):
            importlib.import_module(module)
        else:
            _execute(file)
    except UserError:
        raise
    except SyntaxError as error:
        raise UserError(f"plugin file {file}, line {error.lineno}: {error.msg}") from error
    except (Exception, SystemExit) as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(file)]
        raise UserError(f"plugin file {file}, line {lines[-1] if lines else '?'}: {error}") from error


def _execute(file: Path) -> None:
    name = f"surfexp_plugin_{digest(str(file))}_{file.stem}"
    specification = importlib.util.spec_from_file_location(name, file)
    assert specification is not None and specification.loader is not None  # noqa: S101, narrows a type
    module = sys.modules[name] = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)


def names_of(kind: str) -> list[str]:
    """Names of the plugins of a kind, loaded or not."""
    return list(dict.fromkeys(name for of, name in (*PLUGINS, *DESCRIBED) if of == kind))
