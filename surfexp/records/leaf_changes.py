"""Which leaves of a plan are not recorded as they are, and which runs are no longer those of its leaves."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass

from surfexp.lab.digests import digest
from surfexp.lab.plan.outcome import Outcome
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.records.run_content import KnownRun

# what a run shows: another number writes the runs of earlier versions again
CONTENT = 2


@dataclass(frozen=True)
class LeafChange:
    """A leaf that is not recorded as it is: the stored stages before it, and the run that it takes."""

    leaf: Leaf
    upstream: tuple[str, ...]
    state: str
    run: str | None


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
            changes.append(LeafChange(leaf, stored, state, identity))
            taken |= {identity} if identity else set()
    return changes


def wrongly_tagged(plan: Plan, identities: Mapping[str, str], runs: Iterable[KnownRun]) -> dict[str, list[str]]:
    """The runs whose tag `current` is not right, by what it is to be.

    Of the runs of one configuration those of the plan's leaves are current, whichever code was recorded last; `identities`
    are the runs of leaves by their keys.
    """
    current = {identities[leaf.key] for leaf in plan.leaves}
    configurations = {leaf.configuration for leaf in plan.leaves}
    wrong: dict[str, list[str]] = {"true": [], "false": []}
    for run in runs:
        right = "true" if run.identity in current else "false"
        if run.tags.get("configuration") in configurations and run.tags.get("current") != right:
            wrong[right].append(run.identity)
    return wrong


def _upstream(plan: Plan, key: str, known: dict[str, tuple[str, ...]]) -> tuple[str, ...]:
    """All stages before one, and itself; `known` are those that were asked for before."""
    if key not in known:
        before = dict.fromkeys(one for child in plan.nodes[key].children for one in _upstream(plan, child, known))
        known[key] = (*before, key)
    return known[key]
