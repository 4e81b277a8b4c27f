"""The Laplace-Beltrami eigenmap as a feature."""

from pydantic import Field

from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.skeleton.eigenmap import eigenmap
from surfexp.skeleton.feature import Feature
from surfexp.workflow.registry import Options, register


class Eigenmap(Options):
    """Which eigenfunction."""

    index: int = Field(1, ge=1, le=200, description="number of the eigenfunction, counted from the constant one, 0")


@register("feature", "eigenmap")
def eigenmap_feature(options: Eigenmap, *, surface: Surface, operator: SurfaceOperator) -> Feature:
    """Eigenfunction of the operator, isotropic or weighted, with free boundary (5.4)."""
    return eigenmap(operator, options.index)
