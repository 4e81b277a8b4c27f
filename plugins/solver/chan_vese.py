"""Non-convex two-phase segmentation (2.9)."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.images.initial_curves import disc_distance
from surfexp.variational.models.chan_vese import ChanVese
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import SEGMENTATION_METRICS


class ChanVeseOptions(Options):
    """The weight of the data, the initial function, and when to stop."""

    smoothness: float = Field(
        0.3, gt=0, description="weight of the length of the boundary, without unit; 0: a threshold"
    )
    mu: float | None = Field(None, gt=0, description="the weight of the data as published, in place of smoothness")
    discs: int = Field(0, ge=0, le=10000, description="initial curve: circles about random vertices; 0: where I > mean")
    radius: float = Field(10.0, gt=0, description="radius of an initial circle in edge lengths")
    seed: int = Field(0, ge=0, description="seed of the initial circles")
    height: float = Field(3.0, gt=0, le=100, description="phi starts as +height inside the curve and -height outside")
    tolerance: float = Field(
        1e-6, gt=0, lt=1, description="relative fall of the energy over ten steps at which to stop"
    )
    rest: int = Field(500, ge=1, description="steps without a change of {phi > 0} after which the curve is at rest")
    iteration_limit: int = Field(10000, ge=1, description="most steps")


METRICS = {
    "c1": Metric("mean inside", "unit of the image"),
    "c2": Metric("mean outside", "unit of the image"),
    "perimeter": Metric("length of the zero line", "unit of length"),
    "threshold": Metric("level of the field that bounds the region"),
    "brighter_share": Metric("share of the area in the brighter region"),
    **SEGMENTATION_METRICS,
}


@register("solver", "chan_vese", metrics=METRICS)
def chan_vese_solver(
    options: ChanVeseOptions, *, surface: Surface, image: Image, operator: SurfaceOperator
) -> Solution:
    """Chan-Vese with a regularised Heaviside function by its own descent; a local minimum, no certificate (2.9)."""
    mesh, start = surface.mesh, None
    if options.discs:
        start = disc_distance(mesh, options.discs, options.radius * mesh.edge_length, options.seed) > 0
    settings = options.model_dump(exclude={"discs", "radius", "seed"})
    model = ChanVese(**settings, initial=start)
    return model.run(image, operator, progress=report_progress)
