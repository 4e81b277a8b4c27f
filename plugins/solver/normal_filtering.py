"""Geometry denoising by the total variation of the normals."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.variational.normal_filtering import NormalFiltering
from surfexp.variational.solution import Solution


@register("solver", "normal_filtering", defaults_of=NormalFiltering)
def normal_filtering_solver(
    surface: Surface,
    *,
    weight: Annotated[float, Field(gt=0, description="weight without unit: small is smooth")],
    vertex_steps: Annotated[
        int, Field(ge=1, le=10000, description="steps that fit the vertices to the filtered normals")
    ],
    tolerance: Annotated[float, Field(gt=0, lt=1, description="bound of the relative gap of the normals")],
    iteration_limit: Annotated[int, Field(ge=1, description="most iterations for the normals")],
) -> Solution:
    """Total variation of the face normals, then vertices moved to fit them; the moved vertices are the result."""
    return NormalFiltering(
        weight=weight, vertex_steps=vertex_steps, tolerance=tolerance, iteration_limit=iteration_limit
    ).run(surface.mesh, progress=report_progress)
