"""Which leaves of a plan are not recorded as they are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

from surfexp.lab.digests import digest
from surfexp.lab.plan.outcome import Outcome
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.records.run_content import KnownRun

# what a run shows: another number writes the runs of earlier versions again
CONTENT = 2


@dataclass(frozen=True)
class LeafChange:
    """A leaf that is not recorded as it is: the stored stages before it, the run that it takes, those of older code."""

    leaf: Leaf
    upstream: tuple[str, ...]
    state: str
    run: str | None
    superseded: list[str]


def changes_of(plan: Plan, outcomes: Mapping[str, Outcome], runs: Sequence[KnownRun]) -> list[LeafChange]:
    """The leaves whose run is missing or shows another state of their stages; a failed run of one configuration is taken over."""
    by_leaf = {run.tags.get("leaf"): run for run in runs}
    by_configuration: dict[str | None, list[KnownRun]] = {}
    for run in runs:
        by_configuration.setdefault(run.tags.get("configuration"), []).append(run)
    states = {key: digest(asdict(item)) for key, item in outcomes.items()}
    upstream: dict[str, tuple[str, ...]] = {}
    changes, taken = [], set[str]()
    for leaf in plan.leaves:
        stored = tuple(key for key in _upstream(plan, leaf.key, upstream) if key in outcomes)
        state = digest([[states[key] for key in stored], leaf.configuration, CONTENT])
        same = by_configuration.get(leaf.configuration, [])
        free = (run for run in same if run.status == "FAILED" and run.identity not in taken)
        mine = by_leaf.get(leaf.key) or next(free, None)
        if mine is None or mine.tags.get("state") != state:
            identity = mine.identity if mine else None
            others = [one.identity for one in same if one.identity != identity]
            changes.append(LeafChange(leaf, stored, state, identity, others))
            taken |= {identity} if identity else set()
    return changes


def _upstream(plan: Plan, key: str, known: dict[str, tuple[str, ...]]) -> tuple[str, ...]:
    """All stages before one, and itself; `known` are those that were asked for before."""
    if key not in known:
        before = dict.fromkeys(one for child in plan.nodes[key].children for one in _upstream(plan, child, known))
        known[key] = (*before, key)
    return known[key]
