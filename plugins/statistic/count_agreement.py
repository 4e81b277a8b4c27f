"""How well signatures of one shape repeat."""

from pydantic import Field

from surfexp.spectrum.signature import Signature
from surfexp.statistics.count_agreement import count_agreement, largest_change
from surfexp.statistics.statistic import Statistic
from surfexp.workflow.registry import Options, register


class Agreement(Options):
    """What is compared."""

    part: str = Field("", description="part of the signatures; empty: the signature itself")


@register("statistic", "count_agreement")
def agreement_statistic(options: Agreement, *, reference: Signature, others: dict[str, Signature]) -> Statistic:
    """Share of nodal counts that agree with a reference mesh, by the number of the mode."""
    return count_agreement(reference, others, options.part)


@register("statistic", "signature_change")
def change_statistic(options: Agreement, *, reference: Signature, others: dict[str, Signature]) -> Statistic:
    """Largest and mean relative change of a signature against a reference."""
    return largest_change(reference, others, options.part)
