"""Geometry denoising by the total variation of the normals."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.variational.normal_filtering import NormalFiltering
from surfexp.variational.solution import Solution


class NormalFilteringOptions(Options):
    """The weight of the normals, the vertex updates, and when to stop."""

    w: float = Field(0.5, gt=0, description="weight without unit: small is smooth")
    vertex_steps: int = Field(30, ge=1, le=10000, description="steps that fit the vertices to the filtered normals")
    tolerance: float = Field(1e-4, gt=0, lt=1, description="bound of the relative gap of the normals")
    iteration_limit: int = Field(5000, ge=1, description="most iterations for the normals")


@register("solver", "normal_filtering")
def normal_filtering_solver(options: NormalFilteringOptions, *, surface: Surface) -> Solution:
    """Total variation of the face normals, then vertices moved to fit them; the moved vertices are the result."""
    return NormalFiltering(**dict(options)).run(surface.mesh, progress=report_progress)
