"""Figures 5.8 to 5.10: a group of patches by their eigenmap skeletons."""

from typing import Literal

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.skeleton_study import compactness, group_skeletons, miss_metrics, topology_metrics


class SkeletonStudy(Options):
    """Weight and levels, the same for every member."""

    group: str = Field("", description="what the members are, for the name")
    alpha: float = Field(0.0, ge=0, le=10, description="exponent of the flux weights (5.10); at 0 the weight is 1")
    contrast: float = Field(1.0, gt=0, le=20, description="factor in the exponent of the weights; 1 as published")
    levels: Literal["uniform", "area_quantile", "arc_length"] = Field("arc_length", description="where the levels lie")
    count: int = Field(50, ge=5, le=1000, description="number of levels")
    persistence: float = Field(0.01, ge=0, le=0.5, description="branches below this share of the range are cut off")
    resample: bool = Field(False, description="put points at equal arc length on every line first, whatever its levels")
    scale: bool = Field(False, description="make sizes equal too; rotation and translation are always taken out")
    draws: int = Field(200, ge=10, le=10000, description="bootstrap draws for the intervals of the shares")
    seed: int = Field(0, ge=0, description="seed of the bootstrap")


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


@register("statistic", "skeleton_study", metrics=METRICS)
def skeleton_study_statistic(options: SkeletonStudy, *, surfaces: dict[str, Surface]) -> Statistic:
    """Chains, principal components with bootstrap intervals, and distance from known midlines, of a group's skeletons."""
    skeletons = group_skeletons(
        surfaces, options.alpha, options.contrast, options.levels, options.count, options.persistence
    )
    columns: dict[str, Floats] = {}
    metrics = {**topology_metrics(skeletons), **miss_metrics(surfaces, skeletons)}
    metrics["cut_branches"] = float(np.mean([item.metrics["cut_branches"] for item in skeletons.values()]))
    if len(skeletons) > 1:
        found = compactness(skeletons, options.resample, options.scale, options.draws, options.seed)
        columns = {
            "component": np.arange(1.0, len(found.shares) + 1.0),
            "share": found.shares,
            "low": found.intervals[: len(found.shares), 0],
            "high": found.intervals[: len(found.shares), 1],
            "variance": found.variances,
        }
        metrics |= found.metrics
    weight = "weight 1" if not options.alpha else f"alpha {options.alpha:g}"
    name = f"{weight}, {options.levels.replace('_', ' ')} levels"
    notes = () if columns else ("One member has no principal components.",)
    return Statistic(f"{options.group}, {name}" if options.group else name, columns, metrics=metrics, notes=notes)
