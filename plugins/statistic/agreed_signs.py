"""Signs of modes of people where two maps agree."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp.studies.modes.agreed_signs import agreed_signs

METRICS = {
    "agreed": Metric("leading modes that both maps call their own counterpart with the same sign, a pair"),
    "{rule} right": Metric("share of these with the sign of a rule", better="higher"),
}


@register("statistic", "agreed_signs", metrics=METRICS, defaults_of=agreed_signs)
def agreed_signs_statistic(
    surfaces: dict[Member, Surface],
    systems: dict[Member, EigenSystem],
    *,
    count: Annotated[int, Field(ge=5, le=500, description="modes after the constant")],
) -> Statistic:
    """Proved signs, and those by skewness and largest value, where functional map and map in space agree."""
    return agreed_signs(surfaces, systems, count)
