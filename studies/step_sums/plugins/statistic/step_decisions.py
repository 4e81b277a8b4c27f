"""Decisions by the exact enhancement and by sums over steps."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.variational.image import Image
from surfexp_studies.step_sums.step_decisions import Effect, step_decisions

METRICS = {
    "sets": Metric("data sets"),
    "rejections {method}": Metric("data sets that name a vertex at 5 %", "%"),
    "rejections_low {method}": Metric("lower end of the 95 % interval of their share", "%"),
    "rejections_high {method}": Metric("upper end of the 95 % interval of their share", "%"),
    "level_held {method}": Metric("without effect: 1 where that interval holds 5 %, else 0", better="higher"),
    "power_lost {method}": Metric("power of the exact method less that of this one", "%", "lower"),
    "power {method}": Metric("data sets that name a vertex of the disk at 5 %", "%"),
    "power_low {method}": Metric("lower end of the 95 % interval of their share", "%"),
    "power_high {method}": Metric("upper end of the 95 % interval of their share", "%"),
    "disagreement {method}": Metric("named vertices that only this or only the exact method names", "%"),
    "disagreement_low {method}": Metric("lower end of the 95 % interval of their mean share", "%"),
    "disagreement_high {method}": Metric("upper end of the 95 % interval of their mean share", "%"),
}


@register("statistic", "step_decisions", metrics=METRICS, defaults_of=Effect)
def step_decisions_statistic(
    surface: Surface,
    image: Image,
    *,
    maps: Annotated[int, Field(ge=4, le=1000, description="maps of a data set, in turn among the channels")],
    radius: Annotated[float, Field(gt=0, description="of the disk with an effect, unit of the surface")],
    height: Annotated[float, Field(ge=0, description="effect in the disk, in deviations of the maps")],
    flips: Annotated[int, Field(ge=20, le=100000, description="sign flips, the unchanged one among them")],
    seed: Annotated[int, Field(ge=0, description="seed of disks and flips")],
) -> Statistic:
    """Data sets with a planted effect tested by exact threshold-free enhancement and by sums over five steps."""
    return step_decisions(surface.mesh, image.values, Effect(maps, radius, height, flips, seed))
