"""Power of a comparison of two groups, section 4.5."""

from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.group_power import group_power
from surfexp.statistics.statistic import Statistic


class GroupPower(Options):
    """Sizes of the groups, and the test."""

    sizes: list[int] = Field([3, 4, 5, 6], description="units in each of the two groups")
    level: float = Field(0.05, gt=0, lt=1, description="level of the test")
    draws: int = Field(200, ge=10, le=100000, description="groups that are drawn for each size")
    permutations: int = Field(199, ge=19, le=100000, description="permutations of each test")
    unit: Literal["member", "person"] = Field(
        "member", description="what is drawn into groups: single members, or people with all of theirs"
    )
    permuted: Literal["member", "person"] | None = Field(
        None, description="what changes groups in a permutation, default: the unit; members of one person are alike"
    )
    seed: int = Field(0, ge=0, description="seed of draws and permutations")


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


@register("statistic", "group_power", metrics=METRICS)
def group_power_statistic(options: GroupPower, *, distance_matrix: DistanceMatrix) -> Statistic:
    """How often groups of each size are told apart by a permutation test of their energy distance."""
    return group_power(distance_matrix, **dict(options))
