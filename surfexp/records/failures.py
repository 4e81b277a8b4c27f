"""Why a stage has no result: its own failure, or that of a stage before it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from surfexp.lab.plan.outcome import NOT_COMPUTED, outcome
from surfexp.lab.plan.plan import Plan, stored_inputs
from surfexp.lab.store import store

if TYPE_CHECKING:
    from surfexp.records.table import Row


def cause(plan: Plan, results: Path, key: str, known: dict[str, str]) -> str:
    """Return the first failure among the stages before one, empty where none failed.

    Parameters
    ----------
    plan : Plan
    results : Path
    key : str
        Of a stage that was not computed.
    known : dict of str to str
        The causes that were asked for before, to which this one is added.
    """
    if key not in known:
        known[key] = ""
        for node in (plan.nodes[child] for child in stored_inputs(plan.nodes, key)):
            failure = outcome(results, node).failure
            said = f"{node.kind}/{node.plugin}: {failure}" if failure != NOT_COMPUTED else ""
            if failure and (found := said or cause(plan, results, node.key, known)):
                known[key] = found
                break
    return known[key]


def failures_of(plan: Plan, results: Path, rows: Sequence[Row]) -> Counter[str]:
    """Count why rows have no result, and why figures of rows that have one are missing."""
    found = Counter(row.failure for row in rows if row.failure)
    keys = dict.fromkeys(key for row in rows if not row.failure for key in row.leaf.figures)
    for node in (plan.nodes[key] for key in keys):
        if not store.is_done(results, node.kind, node.key):
            found[f"{node.kind}/{node.plugin}: {outcome(results, node).failure}"] += 1
    return found
