"""Power of a comparison of two groups, section 4.5."""

from collections.abc import Sequence
from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.group_power import group_power
from surfexp.statistics.statistic import Statistic

METRICS = {
    "power {size}": Metric("share of draws in which groups of that size are told apart", better="higher"),
    "false_alarms": Metric("share of draws of both groups from one class that are told apart"),
    "false_alarms_low": Metric("lower end of its exact 95 % interval"),
    "false_alarms_high": Metric("upper end of its exact 95 % interval"),
    "level": Metric("level of the test"),
    "draws": Metric("number of draws"),
    "least_p": Metric("minimum attainable p", better="lower"),
    "p_value": Metric("p of the two whole groups", better="lower"),
}


@register("statistic", "group_power", metrics=METRICS, defaults_of=group_power)
def group_power_statistic(
    distance_matrix: DistanceMatrix,
    *,
    sizes: Annotated[Sequence[int], Field(description="units in each of the two groups")] = [3, 4, 5, 6],
    level: Annotated[float, Field(gt=0, lt=1, description="level of the test")],
    draws: Annotated[int, Field(ge=10, le=100000, description="groups that are drawn for each size")],
    permutations: Annotated[int, Field(ge=19, le=100000, description="permutations of each test")],
    unit: Annotated[
        Literal["member", "person"],
        Field(description="what is drawn into groups: single members, or people with all of theirs"),
    ],
    permuted: Annotated[
        Literal["member", "person"] | None,
        Field(description="what changes groups in a permutation, default: the unit; members of one person are alike"),
    ],
    seed: Annotated[int, Field(ge=0, description="seed of draws and permutations")],
) -> Statistic:
    """How often groups of each size are told apart by a permutation test of their energy distance."""
    return group_power(
        distance_matrix,
        sizes=sizes,
        level=level,
        draws=draws,
        permutations=permutations,
        unit=unit,
        permuted=permuted,
        seed=seed,
    )
