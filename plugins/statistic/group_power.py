"""Power of a comparison of two groups, section 4.5."""

from collections.abc import Sequence
from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.statistics.group_power import group_power

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


register(
    "statistic",
    "group_power",
    metrics=METRICS,
    options={
        "sizes": Annotated[Sequence[int], Field([3, 4, 5, 6], description="units in each of the two groups")],
        "level": Field(gt=0, lt=1, description="level of the test"),
        "draws": Field(ge=10, le=100000, description="groups that are drawn for each size"),
        "permutations": Field(ge=19, le=100000, description="permutations of each test"),
        "unit": Field(description="what is drawn into groups: single members, or people with all of theirs"),
        "permuted": Field(
            description="what changes groups in a permutation, default: the unit; members of one person are alike"
        ),
        "seed": Field(ge=0, description="seed of draws and permutations"),
    },
    names={"matrix": "distance_matrix"},
)(group_power)
