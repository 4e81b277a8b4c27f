"""Section 5.6: local differences of width between two groups."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.positionwise_comparison import false_positive_share, pointwise_test, widths_along
from surfexp.studies.skeletons.skeleton_study import group_skeletons

METRICS = {
    "smallest_corrected_p": Metric("smallest corrected p", better="lower"),
    "positions_found": Metric("positions significant after correction"),
    "positions_uncorrected": Metric("positions significant without correction"),
    "strongest_position": Metric("position of the largest statistic, share of the skeleton"),
    "found_from": Metric("first position found, share of the skeleton"),
    "found_to": Metric("last position found, share of the skeleton"),
    "false_positives": Metric("share of random halvings of one group in which something is found"),
}


@register("statistic", "width_test", metrics=METRICS, defaults_of=(pointwise_test, false_positive_share))
def width_test_statistic(
    first: dict[str, Surface],
    second: dict[str, Surface],
    *,
    group: Annotated[str, Field(description="what the first group is, for the name")] = "",
    positions: Annotated[int, Field(ge=3, le=1000, description="positions along the skeleton")] = 40,
    permutations: Annotated[int, Field(ge=20, le=100000, description="random exchanges of membership")],
    level: Annotated[float, Field(gt=0, lt=1, description="level of the test, over all positions together")],
    halvings: Annotated[
        int, Field(ge=1, le=10000, description="random halvings of the second group, in which nothing is planted")
    ],
    seed: Annotated[int, Field(ge=0, description="seed of the exchanges")],
) -> Statistic:
    """Widths of two groups of patches compared position by position along the skeleton, corrected for multiplicity."""
    groups = [
        np.stack([widths_along(item, positions) for item in group_skeletons(one_group).values()])
        for one_group in (first, second)
    ]
    test = pointwise_test(*groups, permutations=permutations, seed=seed)
    places = (np.arange(positions) + 0.5) / positions
    found = test.corrected <= level
    strongest = int(np.argmax(np.abs(test.statistic)))
    metrics = {
        "smallest_corrected_p": float(test.corrected.min()),
        "positions_found": float(found.sum()),
        "positions_uncorrected": float((test.uncorrected <= level).sum()),
        "strongest_position": float(places[strongest]),
        "found_from": float(places[found].min()) if found.any() else 0.0,
        "found_to": float(places[found].max()) if found.any() else 0.0,
        "false_positives": false_positive_share(groups[1], halvings, level, seed),
    }
    columns = {
        "position": places,
        "first_mean": groups[0].mean(axis=0),
        "second_mean": groups[1].mean(axis=0),
        "corrected_p": test.corrected,
        "uncorrected_p": test.uncorrected,
    }
    name = f"widths of two groups, {group}" if group else "widths of two groups"
    return Statistic(name, columns, metrics=metrics)
