"""How well signatures of one shape repeat."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.spectrum.signature import Signature
from surfexp.statistics.statistic import Statistic
from surfexp.studies.spectra.count_agreement import count_agreement, largest_change

Part = Annotated[str, Field(description="part of the signatures; empty: the signature itself")]


COUNT_AGREEMENT_METRICS = {
    "first_20": Metric("mean share of equal counts among the first 20 modes", better="higher"),
    "all": Metric("mean share of equal counts among all modes", better="higher"),
    "trusted": Metric("mean of the first mode at which the share falls under 0.9", better="higher"),
    "mean_error": Metric("mean difference of the counts", better="lower"),
    "first 20 {label}": Metric("share of equal counts among the first 20 modes", better="higher"),
    "all {label}": Metric("share of equal counts among all modes", better="higher"),
    "trusted {label}": Metric("first mode at which the share falls under 0.9", better="higher"),
}


@register("statistic", "count_agreement", metrics=COUNT_AGREEMENT_METRICS, defaults_of=count_agreement)
def agreement_statistic(reference: Signature, others: dict[str, Signature], *, part: Part) -> Statistic:
    """Share of nodal counts that agree with a reference mesh, by the number of the mode."""
    return count_agreement(reference, others, part)


SIGNATURE_CHANGE_METRICS = {
    "largest": Metric("largest relative change of an entry", better="lower"),
    "mean": Metric("mean relative change of the entries", better="lower"),
}


@register("statistic", "signature_change", metrics=SIGNATURE_CHANGE_METRICS, defaults_of=largest_change)
def change_statistic(reference: Signature, others: dict[str, Signature], *, part: Part) -> Statistic:
    """Largest and mean relative change of a signature against a reference."""
    return largest_change(reference, others, part)
