"""Which modes of two people correspond."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp_studies.modes_across_people.modes_across_people import modes_of_people, modes_of_twins, pooled

METRICS = {
    "pairs": Metric("pairs of surfaces"),
    "modes in blocks of one": Metric("modes whose eigenvalue is apart by 1 % on both surfaces, of those compared"),
    "{fate} by {map}, modes {band}": Metric("share of modes that are themselves, another one or none, by a map"),
    "leading modes": Metric("modes before the first block of several, at most 12, mean"),
    "signs proved": Metric("share of pairs where the signs of these are proved best"),
    "{method} agrees": Metric("share of leading modes to which a method gives their own number and the sign searched"),
    "map and space agree": Metric("share of counterparts named by both maps in which they agree, with the sign"),
}
TWIN_METRICS = {
    "pairs, level {level}": Metric("pairs of surfaces"),
    "itself, level {level}": Metric("share of modes whose true counterpart has their own number"),
    "another, level {level}": Metric("share of modes whose true counterpart has another number"),
    "none, level {level}": Metric("share of modes without a true counterpart"),
    "itself, modes {band}, level {level}": Metric("share of modes whose true counterpart has their own number"),
    "{method} right, level {level}": Metric("share of true counterparts found, with their sign", better="higher"),
    "functional map invents, level {level}": Metric(
        "share of pairs named that have no true counterpart", better="lower"
    ),
    "leading modes, level {level}": Metric("modes before the first block of several, at most 12, mean"),
    "signs proved, level {level}": Metric("share of pairs where the signs of these are proved best"),
    "proved signs right, level {level}": Metric(
        "share of leading modes that are their own true counterpart with the sign that was searched", better="higher"
    ),
}


Count = Annotated[int, Field(ge=5, le=500, description="modes after the constant")]


register(
    "statistic",
    "modes_of_people",
    metrics=METRICS,
    summary="Modes of all pairs of people by order, correlation in space and functional map, with proved signs of the first.",
    given={"report": report_progress},
    options={"count": Field(ge=5, le=500, description="modes after the constant")},
)(modes_of_people)


@register("statistic", "modes_of_twins", metrics=TWIN_METRICS, defaults_of=modes_of_twins)
def modes_of_twins_statistic(
    surface: Surface,
    eigensolver: EigenSystem,
    twins: dict[Member, Surface],
    systems: dict[Member, EigenSystem],
    *,
    count: Count,
) -> Statistic:
    """The same for deformed and disguised copies of one surface, against their true counterparts."""
    members = {member: (twin, systems[member]) for member, twin in twins.items()}
    return modes_of_twins((surface, eigensolver), members, count, report_progress)


register("statistic", "modes_of_people_pooled", metrics=METRICS, options={})(pooled)
