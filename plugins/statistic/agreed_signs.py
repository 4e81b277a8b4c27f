"""Signs of modes of people where two maps agree."""

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp.studies.modes.agreed_signs import agreed_signs

METRICS = {
    "agreed": Metric("leading modes that both maps call their own counterpart with the same sign, a pair"),
    "{rule} right": Metric("share of these with the sign of a rule", better="higher"),
}


class AgreedSigns(Options):
    """How many modes."""

    count: int = Field(50, ge=5, le=500, description="modes after the constant")


@register("statistic", "agreed_signs", metrics=METRICS)
def agreed_signs_statistic(
    options: AgreedSigns, *, surfaces: dict[Member, Surface], systems: dict[Member, EigenSystem]
) -> Statistic:
    """Proved signs, and those by skewness and largest value, where functional map and map in space agree."""
    return agreed_signs(surfaces, systems, options.count)
