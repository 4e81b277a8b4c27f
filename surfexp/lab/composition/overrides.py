"""What the command line says of stages, which wins over variants and grids, and what Hydra composes."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from hydra.errors import OverrideParseException

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.configuration import Settings
from surfexp.lab.experiment.hydra_files import loaded
from surfexp.lab.experiment.interpolation import resolved
from surfexp.lab.experiment.own_data import dataset_called
from surfexp.lab.registry import registry
from surfexp.lab.store.kinds import KINDS

SETTABLE = set(Settings.model_fields) - {"experiment", "results", "variants", "grid", "datasets"}
OURS = {*KINDS, *SETTABLE, "variants", "grid", "datasets"}


@dataclass
class Request:
    """The words of a request by who understands them.

    Attributes
    ----------
    stages : dict
        A plugin or preset as its configuration under the kind, an option or a setting as its value under its dotted name.
    datasets : dict
        Those of `datasets=NAME` under "", of `datasets.DATASET=NAME` under DATASET.
    removed : dict of str to str or None
        Dotted names behind ~, or of stages that are null, with the value that they must have, if one is given.
    required : set of str
        Those of `removed` that have to be there.
    rest : list of str
        What Hydra composes.
    """

    stages: dict[str, Any] = field(default_factory=dict)
    datasets: dict[str, dict[str, Any]] = field(default_factory=dict)
    removed: dict[str, str | None] = field(default_factory=dict)
    required: set[str] = field(default_factory=set)
    rest: list[str] = field(default_factory=list)


def parsed(overrides: Sequence[str]) -> list[Override]:
    """Return the overrides as Hydra reads them.

    Raises
    ------
    UserError
        Naming the word that it cannot read, and how it is quoted.
    """
    parser = OverridesParser.create()
    return [_parsed(parser, text) for text in overrides]


def _parsed(parser: OverridesParser, text: str) -> Override:
    try:
        (override,) = parser.parse_overrides([text])
    except (OverrideParseException, ValueError) as error:
        key, given, value = text.partition("=")
        if not given:
            raise UserError(f"{text!r} sets nothing: write KEY=VALUE, +KEY=VALUE or ~KEY") from error
        reason = str(error).partition("\n")[0].strip()
        # to Hydra a backslash is one, but before a quotation mark
        quoted = re.sub(r'(\\+)(?="|$)', r"\1\1", value).replace('"', '\\"')
        shell = shlex.quote(f'{key}="{quoted}"')
        raise UserError(
            f"{text}: {reason}; text with such characters stands in quotes for Hydra, inside quotes for the shell: {shell}"
        ) from error
    return override


def request_of(overrides: Sequence[str], repository: Any) -> Request:
    """Part the overrides of one job; `repository` is Hydra's, of configuration files."""
    found = Request()
    for text, override in zip(overrides, parsed(overrides), strict=True):
        key = override.key_or_group
        head = key.partition(".")[0]
        if override.is_delete() and head in OURS:
            value = override.value()
            found.removed[key] = None if value in (None, "") else str(value)
            found.required.add(key)
        elif head == "axes":
            raise UserError(
                f"{text.lstrip('+')}: axes are called datasets now: write datasets{text.partition('axes')[2]}"
            )
        elif re.fullmatch(r"datasets(\.[^.]+)?", key) and isinstance(override.value(), str):
            name = "" if key == "datasets._" else key.partition(".")[2]
            found.datasets[name] = dataset_called(str(override.value()), repository)
        elif head not in (*KINDS, *SETTABLE):
            found.rest.append(text)
        elif "." in key or key in SETTABLE:
            found.stages[key] = override.value()
        elif override.value() is None:
            found.removed[key] = None
        else:
            found.stages[key] = _plugin(key, override.value(), repository)
    return found


def _plugin(kind: str, name: Any, repository: Any) -> Any:
    if isinstance(name, dict):
        return name
    found = loaded(f"{kind}/{name}", repository)
    if found is None:
        raise registry.unknown_plugin(kind, kind, str(name))
    return resolved(found.config)


def without(configuration: dict[str, Any], request: Request, dotted: bool) -> dict[str, Any]:
    """Return a configuration without what a request removes, in its variants and grids too.

    Parameters
    ----------
    configuration : dict
    request : Request
    dotted : bool
        Whether options of stages are meant, which have one place once short forms are written out, or whole entries.

    Raises
    ------
    UserError
        If something is to be removed that is not there, or has another value.
    """
    names = {name: value for name, value in request.removed.items() if ("." in name) == dotted}
    if not names:
        return configuration
    configuration = _copied(configuration)
    for name, value in names.items():
        found = [entry for part in _parts(configuration) for entry in _removed(part, name)]
        if not found and name in request.required:
            known = sorted({key for part in _parts(configuration) for key in part if key in OURS})
            raise UserError(f"~{name}: the experiment sets no {name}; it sets: {', '.join(known)}")
        if value is not None and value not in (named := [_word(entry) for entry in found]):
            raise UserError(
                f"~{name}={value}: it is {', '.join(named)}; leave the value out to remove it whatever it is"
            )
    return configuration


def _copied(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _copied(item) for key, item in value.items()}
    return [_copied(item) for item in value] if isinstance(value, list) else value


def _parts(configuration: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """The configuration, its variants, and the grids of all."""
    for part in (configuration, *(configuration.get("variants") or [])):
        yield part
        if isinstance(grid := part.get("grid"), dict):
            yield grid


def _removed(part: dict[str, Any], name: str) -> list[Any]:
    """Take a dotted name out of a part, or all that a grid says below it; return what was there."""
    found = [part.pop(key) for key in list(part) if key == name or key.startswith(f"{name}.")]
    *above, last = name.split(".")
    for key in above:
        part = part.get(key) or {}
        if not isinstance(part, dict):
            return found
    return [*found, part.pop(last)] if above and last in part else found


def _word(entry: Any) -> str:
    return str(entry.get("name", next(iter(entry), ""))) if isinstance(entry, Mapping) else str(entry)
