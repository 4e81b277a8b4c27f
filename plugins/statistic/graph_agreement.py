"""Whether one surface in several poses has one skeleton."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.skeleton.agreement import length_profile, same_graph
from surfexp.skeleton.skeleton import Skeleton
from surfexp.statistics.statistic import Statistic

METRICS = {
    "isomorphic": Metric("share of graphs isomorphic to the first, level by level", better="higher"),
    "width_change": Metric("largest change of a contour's length over their mean", better="lower"),
    "chains": Metric("share of skeletons that are chains", better="higher"),
    "members": Metric("number of skeletons"),
}


@register("statistic", "graph_agreement", metrics=METRICS)
def graph_agreement_statistic(
    skeletons: dict[str, Skeleton],
    *,
    label: Annotated[str, Field(description="feature whose graphs are compared, for the name")] = "eigenmap",
) -> Statistic:
    """Share of the graphs that are isomorphic to the first one, level by level, and the largest change of contour lengths."""
    first = next(iter(skeletons.values()))
    same = np.array([float(same_graph(first, skeleton)) for skeleton in skeletons.values()])
    profile = length_profile(first)
    changes = []
    for skeleton in skeletons.values():
        other = length_profile(skeleton)
        # an eigenfunction's sign is arbitrary: the levels may run the other way
        change = [np.abs(one - profile).max() for one in (other, other[::-1]) if len(one) == len(profile)]
        changes.append(min(change, default=float(profile.max())) / profile.mean())
    metrics = {
        "isomorphic": float(same.mean()),
        "width_change": float(np.max(changes)),
        "chains": float(np.mean([skeleton.is_chain for skeleton in skeletons.values()])),
        "members": float(len(same)),
    }
    return Statistic(
        f"agreement of graphs, {label}", {"same": same, "change": np.array(changes)}, tuple(skeletons), metrics
    )
