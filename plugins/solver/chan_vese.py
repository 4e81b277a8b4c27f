"""Non-convex two-phase segmentation (2.9)."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.images.initial_curves import disc_distance
from surfexp.variational.models.chan_vese import ChanVese
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import SEGMENTATION_METRICS

METRICS = {
    "c1": Metric("mean inside", "unit of the image"),
    "c2": Metric("mean outside", "unit of the image"),
    "perimeter": Metric("length of the zero line", "unit of length"),
    "threshold": Metric("level of the field that bounds the region"),
    "brighter_share": Metric("share of the area in the brighter region"),
    **SEGMENTATION_METRICS,
}


@register("solver", "chan_vese", metrics=METRICS, defaults_of=(disc_distance, ChanVese))
def chan_vese_solver(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    *,
    smoothness: Annotated[
        float, Field(gt=0, description="weight of the length of the boundary, without unit; 0: a threshold")
    ],
    mu: Annotated[float | None, Field(gt=0, description="the weight of the data as published, in place of smoothness")],
    discs: Annotated[
        int, Field(ge=0, le=10000, description="initial curve: circles about random vertices; 0: where I > mean")
    ] = 0,
    radius: Annotated[float, Field(gt=0, description="radius of an initial circle in edge lengths")] = 10.0,
    seed: Annotated[int, Field(ge=0, description="seed of the initial circles")],
    height: Annotated[
        float, Field(gt=0, le=100, description="phi starts as +height inside the curve and -height outside")
    ],
    tolerance: Annotated[
        float, Field(gt=0, lt=1, description="relative fall of the energy over ten steps at which to stop")
    ],
    rest: Annotated[
        int, Field(ge=1, description="steps without a change of {phi > 0} after which the curve is at rest")
    ],
    iteration_limit: Annotated[int, Field(ge=1, description="most steps")],
) -> Solution:
    """Chan-Vese with a regularised Heaviside function by its own descent; a local minimum, no certificate (2.9)."""
    mesh, start = surface.mesh, None
    if discs:
        start = disc_distance(mesh, discs, radius * mesh.edge_length, seed) > 0
    model = ChanVese(
        smoothness=smoothness,
        mu=mu,
        height=height,
        tolerance=tolerance,
        rest=rest,
        iteration_limit=iteration_limit,
        initial=start,
    )
    return model.run(image, operator, progress=report_progress)
