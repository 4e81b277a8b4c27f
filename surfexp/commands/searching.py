"""A search by Hydra's sweeper, which asks for one plan after the other, as one experiment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from surfexp.lab.plan.plan import Plan

SEED = "hydra.sweeper.sampler.seed"


def is_search(arguments: Sequence[str]) -> bool:
    """Whether a command line asks for a sweeper that searches."""
    return any(text.lstrip("+").startswith("hydra/sweeper=optuna") for text in arguments)


def repeatable(arguments: list[str]) -> list[str]:
    """Return the arguments with a seed for the sampler of a search that has none: asked again, it tries the same first.

    So a search that was stopped is continued, and one with more trials begins with those that are there.
    """
    seeded = any(text.partition("=")[0].lstrip("+") == SEED for text in arguments)
    return [*arguments, f"{SEED}=1"] if is_search(arguments) and not seeded else arguments


def joined(before: Plan, plan: Plan) -> Plan:
    """Return the plan of all trials so far: rows in the order in which they were asked for."""
    from surfexp.lab.plan.plan import Plan

    known = {leaf.key for leaf in before.leaves}
    leaves = [*before.leaves, *(leaf for leaf in plan.leaves if leaf.key not in known)]
    return Plan(plan.settings, before.nodes | plan.nodes, leaves, before.requested + plan.requested)
