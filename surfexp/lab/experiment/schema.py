"""A JSON schema of an experiment's file, from the plugins that are known: what an editor completes and checks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pydantic import BaseModel

from surfexp.lab.experiment.claim import Claim
from surfexp.lab.experiment.configuration import Settings
from surfexp.lab.registry.registry import Plugin

Schema = dict[str, Any]
OBJECT: Schema = {"type": "object"}
FACTS: Schema = {"label": {}, "class": {}, "group": {}, "level": {}}
OWN = ("experiment", "results", "figures", "claims", "variants", "datasets", "grid")


def schema_of(plugins: Mapping[tuple[str, str], Plugin]) -> Schema:
    """Return the schema of experiments that use these plugins.

    Parameters
    ----------
    plugins : mapping
        By kind and name.

    Returns
    -------
    dict
        JSON schema, draft 2020-12.
    """
    kinds: dict[str, list[Plugin]] = {}
    for (kind, _), plugin in sorted(plugins.items()):
        kinds.setdefault(kind, []).append(plugin)
    stages = {kind: _stage(methods) for kind, methods in kinds.items()}
    top = {name: item for name, item in _model(Settings)["properties"].items() if name not in OWN}
    common = top | {kind: {"$ref": f"#/$defs/{kind}"} for kind in kinds if kind != "figure"}
    grid = {"type": "object", "additionalProperties": {"type": "array"}}
    common |= {"figures": {"type": "array", "items": {"$ref": "#/$defs/figure"}}, "grid": grid}
    seeds = {"type": "object", "additionalProperties": {"type": "integer", "minimum": 1}}
    parts = {"type": "object", "additionalProperties": OBJECT}
    whole = common | {"experiment": {"type": "string"}, "defaults": {"type": "array"}, "hydra": OBJECT}
    item = {"type": "object", "properties": {**FACTS, "grid": grid, "repeat": seeds}}
    datasets = {"type": "object", "additionalProperties": {"type": "array", "items": item}}
    claims = {"type": "array", "items": _closed(_model(Claim)["properties"])}
    whole |= {"parts": parts, "repeat": seeds, "claims": claims, "datasets": datasets}
    variant = _closed(common | {"<<": {}, "datasets": datasets})
    whole["variants"] = {"type": "array", "items": variant}
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "An experiment of surfexp"}
    return {**head, **_closed(whole), "$defs": stages}


def _stage(methods: Sequence[Plugin]) -> Schema:
    """A plugin's name, or {name: NAME, OPTION: VALUE}; without a name, options of any."""
    forms: list[Schema] = [{"enum": [None, *(method.name for method in methods)]}]
    for method in methods:
        options = {"inputs": OBJECT, **_model(method.options).get("properties", {})}
        if (method.kind, method.name) == ("figure", "sweep"):
            options["against"] = {"description": "an option of the grid: the sweep is drawn once over the whole grid"}
        forms.append({"description": method.summary} | _closed({"name": {"const": method.name}, **options}))
    return {"anyOf": forms}


def _closed(properties: Mapping[str, Any]) -> Schema:
    return {"type": "object", "properties": dict(properties), "additionalProperties": False}


def _model(model: type[BaseModel]) -> Schema:
    """The schema of a model with what it defines put in its places."""
    schema = model.model_json_schema()
    return dict(_inlined(schema, schema.pop("$defs", {})))


def _inlined(part: Any, known: Mapping[str, Any]) -> Any:
    if isinstance(part, Mapping):
        if "$ref" in part:
            return _inlined(known[part["$ref"].rpartition("/")[2]], known)
        return {key: _inlined(value, known) for key, value in part.items()}
    return (
        [_inlined(item, known) for item in part] if isinstance(part, Iterable) and not isinstance(part, str) else part
    )
