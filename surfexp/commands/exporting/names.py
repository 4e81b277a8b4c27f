"""Names of exported files: short, readable, safe whatever a label says, and no two alike."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from surfexp.commands.exporting.selection import upstream
from surfexp.lab.plan.plan import Plan
from surfexp.records.comparison import comparisons
from surfexp.records.table import rows_of

TITLE, VALUE, STEM = 24, 28, 80


@dataclass(frozen=True)
class Named:
    """What files of a stage are called, and what tells it from others: tables, member of a collection, parameters."""

    stem: str
    comparison: str
    label: str
    parameters: Mapping[str, Any]


def slug(value: Any, limit: int = STEM) -> str:
    """Return letters, digits, "_", "-" and inner dots of a value: of a path its last part, of a number six digits."""
    text = f"{value:.6g}" if isinstance(value, float) else str(value).rstrip("/").rpartition("/")[2]
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode().lower()
    safe = re.sub(r"\.{2,}", ".", re.sub(r"[^a-z0-9.-]+", "_", plain)).strip("._-")
    return safe[:limit].strip("._-")


def names_of(plan: Plan, results: Path) -> dict[str, Named]:
    """Return the name of every stored stage of a plan by key; it does not depend on which of them are exported."""
    groups = comparisons(rows_of(plan, results.resolve()))[::-1]  # a row of several tables is named by the first
    titles = {row.leaf.key: group.title for group in groups for row in group.rows}
    varying = {
        row.leaf.key: {name: row.parameters[name] for name in group.varying if name in row.parameters}
        for group in groups
        for row in group.rows
    }
    below = {key: upstream(plan, key) for key in plan.nodes}
    users, labels = _users(plan, below), _labels(plan, below)
    named = {}
    for node in plan.stored:
        leaves = users.get(node.key, [])
        shared = _shared([varying[leaf] for leaf in leaves])
        if node.key not in varying and node.kind != "figure":
            shared = {
                name: value for name, value in shared.items() if _concerns(plan, [*below[node.key], node.key], name)
            }
        said = list(dict.fromkeys(titles[leaf] for leaf in leaves))
        label = next(iter(labels[node.key])) if len(labels.get(node.key, ())) == 1 else ""
        title = slug(said[0], TITLE) if len(groups) > 1 and len(said) == 1 else ""
        values = [_valued(name, value) for name, value in shared.items()]
        parts = [node.kind, title, node.plugin, slug(label, VALUE), *values]
        stem = slug("-".join(filter(None, dict.fromkeys(parts))))
        named[node.key] = Named(stem, "; ".join(said), label, shared)
    counts = Counter(name.stem for name in named.values())
    return {
        key: Named(f"{name.stem}-{key[:8]}", name.comparison, name.label, name.parameters)
        if counts[name.stem] > 1
        else name
        for key, name in named.items()
    }


def _valued(parameter: str, value: Any) -> str:
    """A value that speaks for itself, or a number with the name of its option."""
    option = parameter.rpartition(".")[2]
    return f"{slug(option, TITLE)}_{slug(value)}" if isinstance(value, int | float) else slug(value, VALUE)


def _users(plan: Plan, below: Mapping[str, list[str]]) -> dict[str, list[str]]:
    """The rows that each stage serves."""
    users: dict[str, list[str]] = {}
    for leaf in plan.leaves:
        served = dict.fromkeys(one for key in (leaf.key, *leaf.figures) for one in (*below[key], key))
        for one in served:
            users.setdefault(one, []).append(leaf.key)
    return users


def _labels(plan: Plan, below: Mapping[str, list[str]]) -> dict[str, dict[str, None]]:
    """The labels of the members of collections that each stage serves."""
    labels: dict[str, dict[str, None]] = {}
    collections = (value for node in plan.nodes.values() for value in node.inputs.values() if isinstance(value, dict))
    for members in collections:
        for label, child in members.items():
            for one in (*below[child], child):
                labels.setdefault(one, {})[label] = None
    return labels


def _shared(parameters: list[dict[str, Any]]) -> dict[str, Any]:
    """What several rows agree in."""
    if not parameters:
        return {}
    first, *rest = parameters
    return {name: value for name, value in first.items() if all(one.get(name) == value for one in rest)}


def _concerns(plan: Plan, keys: list[str], parameter: str) -> bool:
    """Whether a parameter is of a stage of this chain: its kind, or the role in which it is an input."""
    stage = parameter.rpartition(".")[0].rpartition(".")[2]
    return any(stage == plan.nodes[key].kind or stage in plan.nodes[key].inputs for key in keys)
