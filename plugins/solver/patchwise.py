"""The parametrization baseline for any genus: patches cut, mapped to the plane and solved each on its own."""

from dataclasses import replace
from functools import partial
from typing import Annotated

from pydantic import Field

from surfexp.baselines.parameter_domain import Parametrized
from surfexp.baselines.patchwise import disk_patches, patchwise_domain, seam_error
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual

METRICS = {
    "relative_gap": Metric(
        "energy on the surface above its proved lower bound, over the scale of the model", "", "lower"
    ),
    "domain_energy": Metric("energy on the parameter domain"),
    "domain_gap": Metric("relative gap on the parameter domain", better="lower"),
    "node_count": Metric("unknowns on the parameter domain"),
    "memory_bytes": Metric("memory of the parameter domain", "bytes", "lower"),
    "length_scale_spread": Metric("99th over 1st percentile of the length scale of the map", better="lower"),
    "length_scale_ratio": Metric("largest over smallest length scale of the map", better="lower"),
    "flipped_faces": Metric("faces whose orientation is turned", better="lower"),
    "angle_error_mean": Metric("mean difference of corner angles", "degrees", "lower"),
    "angle_error_max": Metric("largest difference of corner angles", "degrees", "lower"),
    "quasi_conformal_mean": Metric("mean ratio of singular values, 1 for a conformal map", better="lower"),
    "patches": Metric("number of patches"),
    "seam_vertices": Metric("vertices that belong to several patches"),
    "seam_error": Metric("mean error on the seams", "unit of the image", "lower"),
    "interior_error": Metric("mean error away from the seams", "unit of the image", "lower"),
    "seam_error_share": Metric("part of the error that the seams and their neighbours carry"),
    "seam_area_share": Metric("part of the area that the seams and their neighbours have"),
}


@register(
    "solver", "patchwise", metrics=METRICS, accepts={"model": ("rof", "convex_chan_vese")}, defaults_of=primal_dual
)
def patchwise_solver(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    patches: Annotated[
        int, Field(ge=1, le=1000, description="patches to begin with; those that are no disks are halved")
    ] = 8,
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative gap")] = 0.0001,
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations of one convex problem")],
) -> Solution:
    """Disks mapped to the plane and solved apart; their error at the seams against the intrinsic result (2.4.2)."""
    limits = {"tolerance": tolerance, "iteration_limit": iteration_limit}
    method = partial(primal_dual, **limits, progress=report_progress)
    labels = disk_patches(surface.mesh, patches)
    result = model.run(image, operator, Parametrized(patchwise_domain(surface.mesh, labels), method))
    intrinsic = model.run(image, operator, method)
    errors = seam_error(surface.mesh, labels, result.values, intrinsic.values)
    return replace(result, metrics=result.metrics | errors)
