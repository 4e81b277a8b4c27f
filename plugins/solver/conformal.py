"""The parametrization baseline: the model solved on the sphere, with the conformal factor as weights."""

from functools import partial
from typing import Annotated

from pydantic import Field

from surfexp.baselines.parameter_domain import Parametrized, conformal_domain
from surfexp.baselines.sphere_grid import sphere_grid_domain
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
    "grid_separation": Metric("largest distance of neighbouring grid points on the surface", "unit of length"),
    "area_ratio": Metric("area of the grid over that of the surface"),
}


@register(
    "solver", "conformal", metrics=METRICS, accepts={"model": ("rof", "convex_chan_vese")}, defaults_of=primal_dual
)
def conformal_solver(
    surface: Surface,
    spherical: Surface,
    image: Image,
    operator: SurfaceOperator,
    model: Model,
    *,
    columns: Annotated[
        int, Field(ge=0, le=8192, description="points of a regular grid along the equator; 0: on the vertices")
    ] = 0,
    tolerance: Annotated[
        float, Field(gt=0, lt=1, description="bound of the relative gap on the parameter domain")
    ] = 0.0001,
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations of one convex problem")],
) -> Solution:
    """Primal-dual steps on the spherical image of the surface, on its vertices or a grid of 2 : 1; measured on the surface."""
    mesh, positions = surface.mesh, spherical.mesh.vertices
    grid_columns = columns
    domain = (
        sphere_grid_domain(mesh, positions, grid_columns, grid_columns // 2)
        if grid_columns
        else conformal_domain(mesh, positions)
    )
    limits = {"tolerance": tolerance, "iteration_limit": iteration_limit}
    method = partial(primal_dual, **limits, progress=report_progress)
    return model.run(image, operator, Parametrized(domain, method))
