"""Section 5.6: maps over patches compared point by point, u along the skeleton and v along each contour."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.patch_grid import compare_on_grid, region_found
from surfexp.studies.skeletons.positionwise_comparison import false_positive_share

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


@register(
    "statistic",
    "level_set_parametrization",
    metrics=METRICS,
    defaults_of=(compare_on_grid, region_found, false_positive_share),
)
def level_set_parametrization_statistic(
    first: dict[str, Surface],
    second: dict[str, Surface],
    *,
    group: Annotated[str, Field(description="what the first group is, for the name")] = "",
    map: Annotated[
        str, Field(description='"width", "boundary_distance" or the name of a scalar map of the surfaces')
    ] = "width",
    along: Annotated[int, Field(ge=3, le=1000, description="contours along the skeleton, at equal distances")],
    across: Annotated[int, Field(ge=2, le=1000, description="points along each contour")],
    alpha: Annotated[
        float, Field(ge=0, le=10, description="exponent of the flux weights (5.10); at 0 the weight is 1")
    ],
    ahead: Annotated[tuple[float, float, float], Field(description="direction in which u rises, on the whole")],
    permutations: Annotated[int, Field(ge=20, le=100000, description="random exchanges of membership")],
    level: Annotated[float, Field(gt=0, lt=1, description="level of the test, over all points together")],
    halvings: Annotated[
        int, Field(ge=1, le=10000, description="random halvings of the second group, where nothing differs")
    ] = 100,
    seed: Annotated[int, Field(ge=0, description="seed of the exchanges")],
) -> Statistic:
    """A map compared between two groups of patches at every point (u, v) of their level sets, corrected for multiplicity."""
    found = compare_on_grid(
        first,
        second,
        along=along,
        across=across,
        alpha=alpha,
        chosen=map,
        ahead=ahead,
        permutations=permutations,
        seed=seed,
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
    metrics = region_found(found, level)
    flat = found.second.reshape(len(found.second), -1)
    metrics["false_positives"] = false_positive_share(flat, halvings, level, seed) if len(flat) >= 6 else 0.0
    metrics["left_out"] = float(found.left_out)
    metrics["members"] = float(len(found.first) + len(found.second))
    name = map.replace("_", " ")
    return Statistic(f"{name}, {group}" if group else name, columns, metrics=metrics)
