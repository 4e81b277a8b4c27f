"""What the run of a leaf shows: its options, its numbers and history, what it was made from, its name."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from surfexp.lab.errors import UserError
from surfexp.lab.plan.outcome import NOT_COMPUTED, Outcome
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.lab.registry.registry import plugin
from surfexp.lab.store import store
from surfexp.records.comparison import comparisons
from surfexp.records.leaf_changes import LeafChange
from surfexp.records.run_content import RunContent, RunDataset
from surfexp.records.table import DATA, Row
from surfexp.records.written_numbers import short_name

NOTE = "mlflow.note.content"


def run_of_leaf(
    plan: Plan,
    results: Path,
    change: LeafChange,
    outcomes: Mapping[str, Outcome],
    names: Mapping[str, str],
    tags: Mapping[str, str],
    page: str,
) -> RunContent:
    """What the run of a leaf shows: its options, its numbers and history, what the stages before it took.

    A new run leads to the page with its row; after that its note is a person's.
    """
    leaf, own = change.leaf, outcomes[change.leaf.key]
    upstream = {key: outcomes[key] for key in change.upstream}
    metrics = dict(own.metrics)
    for key, item in upstream.items():
        name = f"seconds.{plan.nodes[key].kind}"
        metrics[name] = metrics.get(name, 0.0) + (item.seconds or 0.0)
        metrics["peak_memory_mb"] = max(metrics.get("peak_memory_mb", 0.0), item.peak_memory_mb or 0.0)
    kind = plan.nodes[leaf.key].kind
    history = {} if own.failure else store.load(results, kind, leaf.key, "history") or {}
    series = [(_safe(key), 0, value) for key, value in metrics.items()]
    steps = history.get("iteration", [])
    series += [
        (f"history.{_safe(key)}", int(step), float(value))
        for key, values in history.items()
        if key != "iteration"
        for step, value in zip(steps, values, strict=False)
    ]
    failures = [item.failure for item in upstream.values() if item.failure not in ("", NOT_COMPUTED)]
    own_tags = {"leaf": leaf.key, "configuration": leaf.configuration, "current": "true", "state": change.state}
    parameters = {key: str(value) for key, value in _used(plan, leaf).items()}
    status = "FAILED" if own.failure else "FINISHED"
    note = (
        {} if change.run else {NOTE: f"A row of [report.html]({page}): `{leaf.key}` in the column leaf of metrics.csv."}
    )
    all_tags = {**tags, **own_tags, **note, "failure": "; ".join(failures)}
    return RunContent(
        names[leaf.key], status, own.seconds or 0.0, parameters, series, all_tags, _datasets(plan, change, results)
    )


def _used(plan: Plan, leaf: Leaf) -> dict[str, Any]:
    """The options of a leaf; of one that was left to its method, what its description says of the default, or nothing."""
    used, given = {}, plan.parameters(leaf)
    for name, value in given.items():
        if value is None:
            stage, _, option = name.rpartition(".")
            kind = stage.rpartition(".")[2]
            value = _default(kind, str(given.get(f"{stage}.name")), option)
        if value is not None:
            used[name] = value
    return used


@cache
def _default(kind: str, method: str, option: str) -> str | None:
    """What the description of an option says behind "default:"; None where it says nothing, or the method is unknown."""
    with suppress(UserError, ImportError, KeyError):
        described = plugin(kind, method).options.model_fields[option].description or ""
        return (described.partition("default: ")[2] and f"default: {described.partition('default: ')[2]}") or None
    return None


def _datasets(plan: Plan, change: LeafChange, results: Path) -> list[RunDataset]:
    """The surfaces and images that a leaf was made from."""
    found = []
    for node in (plan.nodes[key] for key in change.upstream if plan.nodes[key].kind in DATA):
        said = ", ".join(f"{name} {value}" for name, value in node.options.items() if value not in (None, "", []))
        place = store.result_folder(results, node.kind, node.key)
        files = ", ".join(f"{name} sha256 {value}" for name, value in node.files.items())
        profile = json.dumps({"method": node.plugin, "options": said[:500], "files": files[:500]})
        source = json.dumps({"uri": str(place)})
        found.append(RunDataset(f"{node.kind} {node.plugin}", node.key[:36], source, profile))
    return found


def names_of_runs(plan: Plan) -> dict[str, str]:
    """A name for the run of every leaf: what tells it from the others of its table, then the table among several."""
    groups = comparisons([Row(leaf, plan.parameters(leaf), {}, None) for leaf in plan.leaves])
    names = {}
    for group in reversed(groups):  # a row of several tables is named by the first
        for row in group.rows:
            known = [(name, row.parameters[name]) for name in group.varying if row.parameters.get(name) is not None]
            parts = [str(value) if name.endswith(".name") else f"{short_name(name)} {value}" for name, value in known]
            where = [group.title] if len(groups) > 1 else []
            names[row.leaf.key] = " · ".join([*(parts or [row.leaf.key[:8]]), *where])[:250]
    return names


def _safe(name: str) -> str:
    return "".join(c if c.isalnum() or c in "_-./ " else "_" for c in name)
