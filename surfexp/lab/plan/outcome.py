"""What is known of a stage: its numbers from the sealed record of its result, what it took from its event."""

from __future__ import annotations

import contextlib
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from surfexp.lab.errors import DamagedResult
from surfexp.lab.plan.plan import Node
from surfexp.lab.store import store

NOT_COMPUTED = "not computed"


@dataclass(frozen=True)
class Outcome:
    """The numbers of one stage.

    Metrics and notes are part of the result. Processor seconds, peak memory and the kind of machine belong to the run that
    made it, and are None or empty where its event was lost. `failure` says why there is no result, and is empty where there is one.
    """

    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    seconds: float | None = None
    peak_memory_mb: float | None = None
    failure: str = ""
    machine: str = ""


def event_path(results: Path, kind: str, key: str) -> Path:
    """Where the event of a stage lies: what its last run took, or why it failed."""
    return results / "events" / kind / f"{key}.json"


def read_event(results: Path, kind: str, key: str) -> dict[str, Any]:
    """Event of a stage, empty before it ran and where it cannot be read."""
    with contextlib.suppress(OSError, ValueError):
        return dict(json.loads(event_path(results, kind, key).read_text()))
    return {}


def outcome(results: Path, node: Node) -> Outcome:
    """Read the record and the event of a stage; only the record decides whether there is a result."""
    event = read_event(results, node.kind, node.key)
    if not store.is_done(results, node.kind, node.key):
        return Outcome(failure=str(event.get("failure") or NOT_COMPUTED))
    try:
        fields = store.read_record(results, node.kind, node.key)["result"]["fields"]
    except DamagedResult as error:
        return Outcome(failure=str(error))
    metrics = {name: float(value) for name, value in fields.get("metrics", {"map": {}})["map"].items()}
    notes = fields.get("notes", [])
    notes = tuple(notes["tuple"] if isinstance(notes, dict) else notes)
    seconds, memory = _number(event.get("seconds")), _number(event.get("peak_memory_mb"))
    return Outcome(metrics, notes, seconds, memory, machine=str(event.get("machine") or ""))


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, int | float) else None
