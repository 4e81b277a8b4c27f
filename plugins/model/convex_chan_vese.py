"""Convex two-phase segmentation (2.19)."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.images.initial_curves import disc_distance
from surfexp.variational.model import Model
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.truth_metrics import SEGMENTATION_METRICS

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


@register("model", "convex_chan_vese", metrics=METRICS, defaults_of=(disc_distance, ConvexChanVese))
def convex_chan_vese_model(
    surface: Surface,
    *,
    smoothness: Annotated[
        float, Field(gt=0, description="weight of the length of the boundary, without unit; 0: a threshold")
    ],
    mu: Annotated[float | None, Field(gt=0, description="the weight of the data as published, in place of smoothness")],
    updates: Annotated[int, Field(ge=1, le=1000, description="largest number of updates of the two means")],
    divide_by_area: Annotated[
        bool, Field(description="false: the means as published, integrals not divided by the area")
    ],
    discs: Annotated[
        int, Field(ge=0, le=10000, description="initial curve: circles about random vertices; 0: where I > mean")
    ] = 0,
    radius: Annotated[float, Field(gt=0, description="radius of an initial circle in edge lengths")] = 10.0,
    seed: Annotated[int, Field(ge=0, description="seed of the initial circles")],
) -> Model:
    """min over 0 <= phi <= 1 of TV(phi) + mu int phi r, with c1, c2 updated to the means of the two regions (2.19)."""
    mesh, start = surface.mesh, None
    if discs:
        start = disc_distance(mesh, discs, radius * mesh.edge_length, seed) > 0
    return ConvexChanVese(smoothness, mu, start, updates, divide_by_area)
