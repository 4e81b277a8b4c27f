"""Whether the skeletons of a group have one topology."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.skeleton.agreement import topology
from surfexp.skeleton.skeleton import Skeleton
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.skeleton_study import topology_metrics

METRICS = {
    "chains": Metric("share of skeletons that are chains", better="higher"),
    "topologies": Metric("number of different topologies", better="lower"),
    "leaves": Metric("mean number of leaves"),
    "branch_nodes": Metric("mean number of branch nodes"),
    "loops": Metric("mean number of loops"),
    "members": Metric("number of skeletons"),
}


@register("statistic", "skeleton_topology", metrics=METRICS)
def skeleton_topology_statistic(
    skeletons: dict[str, Skeleton],
    *,
    group: Annotated[str, Field(description="what the members are, for the name")] = "",
) -> Statistic:
    """Share of chains among the skeletons of a group, and how many different topologies there are."""
    found = np.array([topology(skeleton) for skeleton in skeletons.values()], dtype=float)
    columns = dict(zip(("leaves", "branch_nodes", "loops"), found.T, strict=True))
    name = f"topology of skeletons, {group}" if group else "topology of skeletons"
    return Statistic(name, columns, tuple(skeletons), topology_metrics(skeletons))
