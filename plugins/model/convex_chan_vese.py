"""Convex two-phase segmentation (2.19)."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.variational.images.initial_curves import disc_distance
from surfexp.variational.model import Model
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.truth_metrics import SEGMENTATION_METRICS


class ConvexChanVeseOptions(Options):
    """The weight of the data, the initial curve, and the updates of the means."""

    smoothness: float = Field(
        0.3, gt=0, description="weight of the length of the boundary, without unit; 0: a threshold"
    )
    mu: float | None = Field(None, gt=0, description="the weight of the data as published, in place of smoothness")
    updates: int = Field(20, ge=1, le=1000, description="largest number of updates of the two means")
    divide_by_area: bool = Field(True, description="false: the means as published, integrals not divided by the area")
    discs: int = Field(0, ge=0, le=10000, description="initial curve: circles about random vertices; 0: where I > mean")
    radius: float = Field(10.0, gt=0, description="radius of an initial circle in edge lengths")
    seed: int = Field(0, ge=0, description="seed of the initial circles")


METRICS = {
    "c1": Metric("mean of the brighter region", "unit of the image"),
    "c2": Metric("mean of the darker region", "unit of the image"),
    "updates": Metric("updates of the two means", better="lower"),
    "threshold": Metric("level of the relaxed field that bounds the region"),
    "trivial_energy": Metric("energy of the best trivial labelling"),
    "labelling_energy": Metric("energy of the labelling"),
    "labelling_gap": Metric(
        "energy of the labelling above the lower bound, over the scale of the model", better="lower"
    ),
    "solver_gap": Metric("relative gap of the solver's own field", better="lower"),
    "brighter_share": Metric("share of the area in the brighter region"),
    "perimeter": Metric("length of the boundary of the region", "unit of length"),
    **SEGMENTATION_METRICS,
}


@register("model", "convex_chan_vese", metrics=METRICS)
def convex_chan_vese_model(options: ConvexChanVeseOptions, *, surface: Surface) -> Model:
    """min over 0 <= phi <= 1 of TV(phi) + mu int phi r, with c1, c2 updated to the means of the two regions (2.19)."""
    mesh, start = surface.mesh, None
    if options.discs:
        start = disc_distance(mesh, options.discs, options.radius * mesh.edge_length, options.seed) > 0
    return ConvexChanVese(options.smoothness, options.mu, start, options.updates, options.divide_by_area)
