"""Section 5.6: local differences of width between two groups."""

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.positionwise_comparison import false_positive_share, pointwise_test, widths_along
from surfexp.studies.skeletons.skeleton_study import group_skeletons


class WidthTest(Options):
    """How the groups are compared."""

    group: str = Field("", description="what the first group is, for the name")
    positions: int = Field(40, ge=3, le=1000, description="positions along the skeleton")
    permutations: int = Field(1000, ge=20, le=100000, description="random exchanges of membership")
    level: float = Field(0.05, gt=0, lt=1, description="level of the test, over all positions together")
    halvings: int = Field(
        200, ge=1, le=10000, description="random halvings of the second group, in which nothing is planted"
    )
    seed: int = Field(0, ge=0, description="seed of the exchanges")


METRICS = {
    "smallest_corrected_p": Metric("smallest corrected p", better="lower"),
    "positions_found": Metric("positions significant after correction"),
    "positions_uncorrected": Metric("positions significant without correction"),
    "strongest_position": Metric("position of the largest statistic, share of the skeleton"),
    "found_from": Metric("first position found, share of the skeleton"),
    "found_to": Metric("last position found, share of the skeleton"),
    "false_positives": Metric("share of random halvings of one group in which something is found"),
}


@register("statistic", "width_test", metrics=METRICS)
def width_test_statistic(options: WidthTest, *, first: dict[str, Surface], second: dict[str, Surface]) -> Statistic:
    """Widths of two groups of patches compared position by position along the skeleton, corrected for multiplicity."""
    groups = [
        np.stack([widths_along(item, options.positions) for item in group_skeletons(group).values()])
        for group in (first, second)
    ]
    test = pointwise_test(*groups, permutations=options.permutations, seed=options.seed)
    places = (np.arange(options.positions) + 0.5) / options.positions
    found = test.corrected <= options.level
    strongest = int(np.argmax(np.abs(test.statistic)))
    metrics = {
        "smallest_corrected_p": float(test.corrected.min()),
        "positions_found": float(found.sum()),
        "positions_uncorrected": float((test.uncorrected <= options.level).sum()),
        "strongest_position": float(places[strongest]),
        "found_from": float(places[found].min()) if found.any() else 0.0,
        "found_to": float(places[found].max()) if found.any() else 0.0,
        "false_positives": false_positive_share(groups[1], options.halvings, options.level, options.seed),
    }
    columns = {
        "position": places,
        "first_mean": groups[0].mean(axis=0),
        "second_mean": groups[1].mean(axis=0),
        "corrected_p": test.corrected,
        "uncorrected_p": test.uncorrected,
    }
    name = f"widths of two groups, {options.group}" if options.group else "widths of two groups"
    return Statistic(name, columns, metrics=metrics)
