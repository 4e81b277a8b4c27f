"""The conformal image of a surface on the unit sphere."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.baselines.conformal_flow import conformal_flow
from surfexp.baselines.distortion import distortion
from surfexp.baselines.parameter_domain import image_mesh
from surfexp.baselines.spherical_map import spherical_map
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface

METRICS = {
    "length_scale_spread": Metric("99th over 1st percentile of the length scale of the map", better="lower"),
    "length_scale_ratio": Metric("largest over smallest length scale of the map", better="lower"),
    "flipped_faces": Metric("faces whose orientation is turned", better="lower"),
    "angle_error_mean": Metric("mean difference of corner angles", "degrees", "lower"),
    "angle_error_max": Metric("largest difference of corner angles", "degrees", "lower"),
    "quasi_conformal_mean": Metric("mean ratio of singular values, 1 for a conformal map", better="lower"),
}


@register("surface", "spherical_map", metrics=METRICS, defaults_of=conformal_flow)
def spherical_map_surface(
    original: Surface,
    *,
    method: Annotated[
        Literal["linear", "flow"],
        Field(description="linear: one linear system; flow: improved by conformal mean curvature flow"),
    ] = "linear",
    step_limit: Annotated[int, Field(ge=1, le=10000, description="most steps of the flow")],
) -> Surface:
    """Conformal map of a closed genus-0 surface to the sphere: the preprocessing of the parametrization method."""
    mesh = original.mesh
    positions = spherical_map(mesh)
    if method == "flow":
        positions = conformal_flow(mesh, positions, step_limit=step_limit, progress=report_progress)
    image = image_mesh(mesh, positions)
    return Surface(image, f"spherical image of the {original.name}", metrics=distortion(mesh, image, np.zeros(3)))
