"""Rejections of null models against the correlation length."""

from surfexp.contract.member import Member, levels_of
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.statistics.statistic import Statistic
from surfexp.studies.nulls.null_rejections import rejections_by_length

METRICS = {
    "lengths": Metric("correlation lengths"),
    "exact_lengths {method}": Metric("correlation lengths at which the interval meets 4 to 6 %", better="higher"),
}


@register("statistic", "rejections_by_length", metrics=METRICS)
def rejections_by_length_statistic(statistics: dict[Member, Statistic]) -> Statistic:
    """Rejections of null models against the correlation length, which is the level of each member."""
    return rejections_by_length(statistics, levels_of(statistics))
