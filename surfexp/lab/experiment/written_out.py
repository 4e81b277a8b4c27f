"""What an experiment's file leaves to be worked out: names of parts, seeds, items of datasets, sweeps, the end of a chain."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from surfexp.lab.errors import UserError
from surfexp.lab.experiment.datasets import datasets_written_out, seeds, with_sweeps
from surfexp.lab.experiment.former_spelling import refuse_former_spelling
from surfexp.lab.experiment.yaml_files import check_variants
from surfexp.lab.registry.registry import names_of
from surfexp.lab.store.kinds import KINDS

Configuration = dict[str, Any]
# what is no part of an experiment, and where it belongs
OUTSIDE = {
    "results": "give results=FOLDER to surfexp run",
    "hydra": "a file that sets Hydra's own keys begins with the line # @package _global_",
}
# what stands below these keys, and how a refusal says it
SHAPES: dict[str, tuple[type, str]] = {
    "parts": (Mapping, "names with stages are needed: NAME: {surface: ...}"),
    "repeat": (Mapping, "seeds with a number of repetitions are needed: image.seed: 3"),
    "datasets": (Mapping, "lists of items by name are needed: NAME: [{label: LABEL, surface: ...}]"),
    "figures": (list, "a list of figures is needed: [denoising]"),
    "claims": (list, "a list of claims is needed: - {claim: STATEMENT, quantity: {max: METRIC}, between: [null, 1]}"),
}


def named(composed: Mapping[str, Any], name: str | None) -> Configuration:
    """Return a composition with what the experiment's file says at its top, named as the file is.

    Parameters
    ----------
    composed : mapping
        As Hydra composes it: a file without the line `# @package _global_` comes under the key `experiment`.
    name : str or None
        Of the file.

    Raises
    ------
    UserError
        If the file has another name for itself, or sets what is not the experiment's.
    """
    content = composed.get("experiment")
    if not isinstance(content, Mapping):
        return dict(composed)
    for key, way_out in OUTSIDE.items():
        if key in content:
            raise UserError(f"experiment {name}: {key!r} is no part of an experiment; {way_out}")
    if (own := content.get("experiment", name)) != name:
        raise UserError(f"experiment {name}: it calls itself {own!r}; leave the key out, its file's name is its name")
    given = {key: value for key, value in composed.items() if key != "experiment" and value is not None}
    return {**composed, **content, **given, "experiment": str(name)}


def written_out(composed: Mapping[str, Any], given: Mapping[str, Any] | None = None) -> Configuration:
    """Return a composed configuration as the planner reads it.

    Parameters
    ----------
    composed : mapping
        May hold `parts`, by name, which inputs then name; `repeat`, options with the number of seeds; items of datasets with
        a grid or seeds; figures {name: sweep, metric: METRIC, against: OPTION}.
    given : mapping, optional
        What the command line says of stages, as `expand` takes it: it stands in the grid in place of the grid's own values, so
        that what is drawn over the whole grid follows it.

    Returns
    -------
    dict

    Raises
    ------
    UserError
        Naming the entry and what it should be; for the spelling of an earlier version, the present one.

    Examples
    --------
    >>> written_out({"surface": {"name": "cup", "vertices": 4000}, "repeat": {"image.seed": 2}})["grid"]
    {'image.seed': [0, 1]}
    """
    refuse_former_spelling(composed, lambda kind, plugin: plugin in names_of(kind))
    _check_shapes(composed, "the experiment")
    check_variants(composed)
    parts = composed.get("parts") or {}
    own: Configuration = {}
    for name, part in parts.items():  # a part may be made of those before it
        own[name] = _stages(part, own)
    found: Configuration = _stages(
        {key: value for key, value in composed.items() if key not in ("parts", "repeat")}, own
    )
    if repeated := seeds(composed.get("repeat") or {}):
        found["grid"] = {**(found.get("grid") or {}), **repeated}
    if given and (grid := found.get("grid")):
        found["grid"] = {option: [given[option]] if option in given else values for option, values in grid.items()}
    found = with_sweeps(datasets_written_out(found))
    if "target" not in found and (last := _last_kind(found, given or {})):
        found["target"] = last
    return found


def _check_shapes(part: Any, where: str) -> None:
    """Refuse keys that are no text, and lists and mappings that are none."""
    for key, value in part.items() if isinstance(part, Mapping) else ():
        if not isinstance(key, str):
            raise UserError(f"{where}: key {key!r} is no text; put it in quotation marks")
        shape, needed = SHAPES.get(key, (object, ""))
        if value is not None and not isinstance(value, shape) and where in ("the experiment", "a variant"):
            raise UserError(f"{key} is {str(value)[:80]!r}, {needed}")
        if key == "datasets" and isinstance(value, Mapping):
            for name, items in value.items():
                if not isinstance(items, list) or not all(isinstance(item, Mapping) for item in items):
                    raise UserError(
                        f"dataset {name} is {str(items)[:80]!r}, a list of items is needed: [{{label: LABEL}}]"
                    )
                for item in items:
                    _check_shapes(item, f"dataset {name}")
        elif key == "variants" and isinstance(value, list):
            for variant in value:
                _check_shapes(variant, "a variant")
        else:
            for item in value if isinstance(value, list) else [value]:
                _check_shapes(item, key)


def _last_kind(found: Mapping[str, Any], asked: Mapping[str, Any]) -> str:
    """What a chain ends with if nothing says it: the last kind that is named, unless that is the usual one, a solver."""
    partial = [found, *(found.get("variants") or [])]
    keys = {key.partition(".")[0] for part in partial for key in [*part, *(part.get("grid") or {})]} | set(asked)
    given = [kind for kind in KINDS if kind in keys and kind != "figure"]
    stated = any("target" in variant for variant in found.get("variants") or [])
    return "" if stated or "solver" in given or not given else given[-1]


def _stages(part: Any, parts: Mapping[str, Any]) -> Any:
    """A partial configuration in which inputs are what the parts say that they name."""
    if not isinstance(part, Mapping):
        return part
    return {key: _entry(key, value, parts) for key, value in part.items()}


def _entry(key: str, value: Any, parts: Mapping[str, Any]) -> Any:
    if key in KINDS:
        return _stage(value, parts)
    if key == "figures" and isinstance(value, list):
        return [_stage(figure, parts) for figure in value]
    if key == "variants":
        return [_stages(variant, parts) for variant in value or []]
    if key == "grid" and isinstance(value, Mapping):
        return {
            option: [_stage(item, parts) for item in items] if option in KINDS and isinstance(items, list) else items
            for option, items in value.items()
        }
    if key == "datasets" and isinstance(value, Mapping):
        return {name: [_stages(item, parts) for item in items] for name, items in value.items()}
    return value


def _stage(value: Any, parts: Mapping[str, Any]) -> Any:
    if not isinstance(value, Mapping) or not isinstance(inputs := value.get("inputs"), Mapping):
        return value
    return {**value, "inputs": {role: _input(role, given, parts) for role, given in inputs.items()}}


def _input(role: str, given: Any, parts: Mapping[str, Any]) -> Any:
    if not isinstance(given, str):
        return _stages(given, parts)
    if given not in parts:
        known = ", ".join(map(repr, parts)) or "none"
        raise UserError(f"input {role!r}: {given!r} is no part of this experiment; its parts: {known}")
    return parts[given]
