"""Maps rebuilt from modes of their own surface and of other geometries."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp.studies.modes.geometric_modes import mode_reconstruction, reconstruction_differences

METRICS = {
    "area {map}, {basis}": Metric("mean accuracy of a map over log of the number of modes", better="higher"),
    "end {map}, {basis}": Metric("accuracy of a map by all modes", better="higher"),
    "{basis} less {other}, {map}": Metric("area of one basis less that of another, on one map"),
}
DIFFERENCE_METRICS = {
    "maps": Metric("maps that the intervals are drawn from"),
    "{basis} less {other}": Metric("area of one basis less that of another, mean over maps; or an end of its interval"),
}


@register("statistic", "mode_reconstruction", metrics=METRICS, defaults_of=mode_reconstruction)
def mode_reconstruction_statistic(
    surface: Surface,
    operator: SurfaceOperator,
    eigensolver: EigenSystem,
    bases: dict[Member, EigenSystem],
    *,
    maps: Annotated[tuple[str, ...], Field(description="maps of the surface")] = (),
    twins: Annotated[tuple[str, ...], Field(description="bases of whose modes random maps are made: own, or a class")],
    seeds: Annotated[int, Field(ge=1, le=1000, description="random maps of each")],
    first: Annotated[int, Field(ge=1, le=5000, description="fewest modes")],
    last: Annotated[int, Field(ge=2, le=5000, description="most modes")],
) -> Statistic:
    """Accuracy of maps rebuilt from k modes of the surface itself and of other geometries on its vertices."""
    return mode_reconstruction(
        surface, operator, eigensolver, bases, maps=maps, twins=twins, seeds=seeds, first=first, last=last
    )


@register("statistic", "reconstruction_differences", metrics=DIFFERENCE_METRICS, defaults_of=reconstruction_differences)
def reconstruction_differences_statistic(
    statistics: dict[Member, Statistic],
    *,
    maps: Annotated[tuple[str, ...], Field(min_length=2, description="maps, drawn with replacement")] = (
        "thickness",
        "sulc",
    ),
    seed: Annotated[int, Field(ge=0, description="seed of the draws")],
) -> Statistic:
    """Own modes against each other basis, paired by map, with intervals by bootstrap of maps."""
    return reconstruction_differences(statistics, maps, seed=seed)
