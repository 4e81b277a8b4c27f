"""Explicit diffusion with the gradient and divergence in three forms, remark 1.3.1."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.calculus import divergence, gradient
from surfexp.operators.first_ring import ring_divergence, ring_gradient
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution

METRICS = {
    "mean": Metric("mean of the image", "unit of the image"),
    "deviation": Metric("root mean square of the image", "unit of the image"),
}


@register("solver", "explicit_diffusion", metrics=METRICS, accepts={"operator": ("vertex_averaged",)})
def explicit_diffusion_solver(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    *,
    form: Annotated[
        Literal["matrix", "formulas", "faces"],
        Field(description="sparse products (1.27), definitions (1.17) and (1.18) each time, or stored face gradients"),
    ] = "matrix",
    steps: Annotated[int, Field(ge=1, le=100000, description="number of steps")] = 500,
    step: Annotated[float, Field(gt=0, le=0.1, description="length of a step in squared edge lengths")] = 0.01,
) -> Solution:
    """Steps u + dt div grad u, the loop whose cost remark 1.3.1 is about; nothing is minimised."""
    vertices, faces, matrices = surface.mesh.vertices, surface.mesh.faces, operator.averaged_gradient
    if image.values.ndim != 1 or matrices is None:
        raise ValueError(f"image {image.name!r} has shape {image.values.shape}, diffusion takes one value a vertex")
    values, used_step = image.values.astype(np.float64), step * operator.edge_length**2
    for _ in range(steps):
        if form == "matrix":
            change = sum((w @ (w @ values) for w in matrices[1:]), start=matrices[0] @ (matrices[0] @ values))
        elif form == "formulas":
            change = ring_divergence(vertices, faces, ring_gradient(vertices, faces, values))
        else:
            change = divergence(operator, gradient(operator, values))
        values = values + used_step * change
    mass = operator.mass
    metrics = {"mean": float(mass @ values / mass.sum()), "deviation": float(np.sqrt(mass @ values**2 / mass.sum()))}
    return Solution(values, 0.0, reason="all steps", model="diffusion", solver=form, metrics=metrics)
