"""Figures 5.8 to 5.10: a group of patches by their eigenmap skeletons."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.skeleton_study import compactness, group_skeletons, miss_metrics, topology_metrics

METRICS = {
    "chains": Metric("share of skeletons that are chains", better="higher"),
    "topologies": Metric("number of different topologies", better="lower"),
    "leaves": Metric("mean number of leaves"),
    "branch_nodes": Metric("mean number of branch nodes"),
    "loops": Metric("mean number of loops"),
    "members": Metric("number of skeletons"),
    "cut_branches": Metric("mean number of branches that the simplification cut off"),
    "midline_miss": Metric("mean of the largest distance of the midline to the skeleton", "edge lengths", "lower"),
    "midline_miss_worst": Metric("largest distance of a midline to its skeleton", "edge lengths", "lower"),
    "skeleton_excess": Metric("mean of the largest distance of the skeleton to the midline", "edge lengths", "lower"),
    "genu_miss": Metric("mean of the largest distance of the genu's midline to the skeleton", "edge lengths", "lower"),
    "first_share": Metric("variance share of the first principal component", better="higher"),
    "first_share_low": Metric("lower end of its 95 % bootstrap interval"),
    "first_share_high": Metric("upper end of its 95 % bootstrap interval"),
    "first_three_share": Metric("variance share of the first three principal components", better="higher"),
    "total_variance": Metric("total variance", better="lower"),
    "coverage": Metric("length of the skeleton's line over that between all levels", better="higher"),
}


@register("statistic", "skeleton_study", metrics=METRICS, defaults_of=(group_skeletons, compactness))
def skeleton_study_statistic(
    surfaces: dict[str, Surface],
    *,
    group: Annotated[str, Field(description="what the members are, for the name")] = "",
    alpha: Annotated[
        float, Field(ge=0, le=10, description="exponent of the flux weights (5.10); at 0 the weight is 1")
    ],
    contrast: Annotated[float, Field(gt=0, le=20, description="factor in the exponent of the weights; 1 as published")],
    levels: Annotated[Literal["uniform", "area_quantile", "arc_length"], Field(description="where the levels lie")],
    count: Annotated[int, Field(ge=5, le=1000, description="number of levels")],
    persistence: Annotated[
        float, Field(ge=0, le=0.5, description="branches below this share of the range are cut off")
    ],
    resample: Annotated[
        bool, Field(description="put points at equal arc length on every line first, whatever its levels")
    ],
    scale: Annotated[bool, Field(description="make sizes equal too; rotation and translation are always taken out")],
    draws: Annotated[int, Field(ge=10, le=10000, description="bootstrap draws for the intervals of the shares")],
    seed: Annotated[int, Field(ge=0, description="seed of the bootstrap")],
) -> Statistic:
    """Chains, principal components with bootstrap intervals, and distance from known midlines, of a group's skeletons."""
    skeletons = group_skeletons(surfaces, alpha, contrast, levels, count, persistence)
    columns: dict[str, Floats] = {}
    metrics = {**topology_metrics(skeletons), **miss_metrics(surfaces, skeletons)}
    metrics["cut_branches"] = float(np.mean([item.metrics["cut_branches"] for item in skeletons.values()]))
    if len(skeletons) > 1:
        found = compactness(skeletons, resample, scale, draws, seed)
        columns = {
            "component": np.arange(1.0, len(found.shares) + 1.0),
            "share": found.shares,
            "low": found.intervals[: len(found.shares), 0],
            "high": found.intervals[: len(found.shares), 1],
            "variance": found.variances,
        }
        metrics |= found.metrics
    weight = "weight 1" if not alpha else f"alpha {alpha:g}"
    name = f"{weight}, {levels.replace('_', ' ')} levels"
    notes = () if columns else ("One member has no principal components.",)
    return Statistic(f"{group}, {name}" if group else name, columns, metrics=metrics, notes=notes)
