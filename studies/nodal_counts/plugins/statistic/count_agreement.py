"""How well signatures of one shape repeat."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.nodal_counts.count_agreement import count_agreement, largest_change

PART = Field(description="part of the signatures; empty: the signature itself")


COUNT_AGREEMENT_METRICS = {
    "first_20": Metric("mean share of equal counts among the first 20 modes", better="higher"),
    "all": Metric("mean share of equal counts among all modes", better="higher"),
    "trusted": Metric("mean of the first mode at which the share falls under 0.9", better="higher"),
    "mean_error": Metric("mean difference of the counts", better="lower"),
    "first 20 {label}": Metric("share of equal counts among the first 20 modes", better="higher"),
    "all {label}": Metric("share of equal counts among all modes", better="higher"),
    "trusted {label}": Metric("first mode at which the share falls under 0.9", better="higher"),
}


register(
    "statistic",
    "count_agreement",
    metrics=COUNT_AGREEMENT_METRICS,
    options={"part": PART},
)(count_agreement)


SIGNATURE_CHANGE_METRICS = {
    "largest": Metric("largest relative change of an entry", better="lower"),
    "mean": Metric("mean relative change of the entries", better="lower"),
}


register(
    "statistic",
    "signature_change",
    metrics=SIGNATURE_CHANGE_METRICS,
    options={"part": PART},
)(largest_change)
