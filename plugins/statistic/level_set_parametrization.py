"""Section 5.6: maps over patches compared point by point, u along the skeleton and v along each contour."""

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.patch_grid import compare_on_grid, region_found
from surfexp.studies.skeletons.positionwise_comparison import false_positive_share


class LevelSetParametrization(Options):
    """Which map, on which grid, and how the groups are compared."""

    group: str = Field("", description="what the first group is, for the name")
    map: str = Field("width", description='"width", "boundary_distance" or the name of a scalar map of the surfaces')
    along: int = Field(40, ge=3, le=1000, description="contours along the skeleton, at equal distances")
    across: int = Field(15, ge=2, le=1000, description="points along each contour")
    alpha: float = Field(0.0, ge=0, le=10, description="exponent of the flux weights (5.10); at 0 the weight is 1")
    ahead: tuple[float, float, float] = Field((1.0, 0.0, 0.0), description="direction in which u rises, on the whole")
    permutations: int = Field(1000, ge=20, le=100000, description="random exchanges of membership")
    level: float = Field(0.05, gt=0, lt=1, description="level of the test, over all points together")
    halvings: int = Field(100, ge=1, le=10000, description="random halvings of the second group, where nothing differs")
    seed: int = Field(0, ge=0, description="seed of the exchanges")


METRICS = {
    "points": Metric("points of the grid"),
    "points_found": Metric("points significant after correction"),
    "share_found": Metric("share of points significant after correction"),
    "points_uncorrected": Metric("points significant without correction"),
    "smallest_corrected_p": Metric("smallest corrected p", better="lower"),
    "centre_u": Metric("centre of the points found, along"),
    "centre_v": Metric("centre of the points found, across"),
    "from_u": Metric("first point found, along"),
    "to_u": Metric("last point found, along"),
    "from_v": Metric("first point found, across"),
    "to_v": Metric("last point found, across"),
    "false_positives": Metric("share of random halvings of one group in which something is found"),
    "left_out": Metric("points of the grid left out"),
    "members": Metric("members of both groups"),
}


@register("statistic", "level_set_parametrization", metrics=METRICS)
def level_set_parametrization_statistic(
    options: LevelSetParametrization, *, first: dict[str, Surface], second: dict[str, Surface]
) -> Statistic:
    """A map compared between two groups of patches at every point (u, v) of their level sets, corrected for multiplicity."""
    found = compare_on_grid(
        first,
        second,
        along=options.along,
        across=options.across,
        alpha=options.alpha,
        chosen=options.map,
        ahead=options.ahead,
        permutations=options.permutations,
        seed=options.seed,
    )
    u, v = (places.ravel() for places in np.meshgrid(found.u, found.v, indexing="ij"))
    columns = {
        "u": u,
        "v": v,
        "first_mean": found.first.mean(axis=0).ravel(),
        "second_mean": found.second.mean(axis=0).ravel(),
        "statistic": found.test.statistic,
        "corrected_p": found.test.corrected,
        "uncorrected_p": found.test.uncorrected,
    }
    metrics = region_found(found, options.level)
    flat = found.second.reshape(len(found.second), -1)
    metrics["false_positives"] = (
        false_positive_share(flat, options.halvings, options.level, options.seed) if len(flat) >= 6 else 0.0
    )
    metrics["left_out"] = float(found.left_out)
    metrics["members"] = float(len(found.first) + len(found.second))
    name = options.map.replace("_", " ")
    return Statistic(f"{name}, {options.group}" if options.group else name, columns, metrics=metrics)
