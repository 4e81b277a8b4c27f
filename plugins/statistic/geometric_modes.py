"""Maps rebuilt from modes of their own surface and of other geometries."""

from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
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


class ModeReconstruction(Options):
    """Which maps, and from how many modes."""

    maps: tuple[str, ...] = Field((), description="maps of the surface")
    twins: tuple[str, ...] = Field((), description="bases of whose modes random maps are made: own, or a class")
    seeds: int = Field(20, ge=1, le=1000, description="random maps of each")
    first: int = Field(10, ge=1, le=5000, description="fewest modes")
    last: int = Field(400, ge=2, le=5000, description="most modes")


@register("statistic", "mode_reconstruction", metrics=METRICS)
def mode_reconstruction_statistic(
    options: ModeReconstruction,
    *,
    surface: Surface,
    operator: SurfaceOperator,
    eigensolver: EigenSystem,
    bases: dict[Member, EigenSystem],
) -> Statistic:
    """Accuracy of maps rebuilt from k modes of the surface itself and of other geometries on its vertices."""
    return mode_reconstruction(surface, operator, eigensolver, bases, **dict(options))


class ReconstructionDifferences(Options):
    """Over which maps."""

    maps: tuple[str, ...] = Field(("thickness", "sulc"), min_length=2, description="maps, drawn with replacement")
    seed: int = Field(0, ge=0, description="seed of the draws")


@register("statistic", "reconstruction_differences", metrics=DIFFERENCE_METRICS)
def reconstruction_differences_statistic(
    options: ReconstructionDifferences, *, statistics: dict[Member, Statistic]
) -> Statistic:
    """Own modes against each other basis, paired by map, with intervals by bootstrap of maps."""
    return reconstruction_differences(statistics, options.maps, seed=options.seed)
