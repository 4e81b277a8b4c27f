"""Stages of a plan without a sound result: which they are, and what is left of them is removed."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

from surfexp.commands.terminal import echo
from surfexp.lab.plan.outcome import event_path, read_event
from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import store

LINES_OF_DAMAGE = 10


def unfinished(plan: Plan, results: Path) -> dict[str, str]:
    """Stages of a plan without a sound result, by key: "" where there is none, else what is wrong with it.

    In benchmark mode, a leaf that was not measured alone is among them.
    """
    leaves = [plan.nodes[leaf.key] for leaf in plan.leaves] if plan.settings.timing else []
    events = {node.key: read_event(results, node.kind, node.key) for node in leaves}
    untimed = {key: "" for key, event in events.items() if event.get("failure") or not event.get("alone")}
    return untimed | store.faults(results, [(node.kind, node.key) for node in plan.stored])


def clear(plan: Plan, results: Path, missing: Mapping[str, str]) -> None:
    """Remove what is left of unfinished stages: damaged results, which are named, and the traces of earlier runs.

    Sound results that are to be measured again are set aside.
    """
    lines = []
    for key, fault in missing.items():
        kind = plan.nodes[key].kind
        lines += [fault] if fault else [read_event(results, kind, key).get("damage", "")]
        is_sound = not fault and store.is_done(results, kind, key)
        (store.set_aside if is_sound else store.discard)(results, kind, key)
        for suffix in (".json", ".progress"):
            event_path(results, kind, key).with_suffix(suffix).unlink(missing_ok=True)
    lines = [line for line in lines if line]
    for line in lines[:LINES_OF_DAMAGE]:
        echo(f"surfexp: {line}; it is removed and computed again", err=True)
    if len(lines) > LINES_OF_DAMAGE:
        print(f"surfexp: and {len(lines) - LINES_OF_DAMAGE} results more", file=sys.stderr)
