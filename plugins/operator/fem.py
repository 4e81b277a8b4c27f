"""Per-face gradients with their exact adjoint."""

from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.workflow.registry import Options, register


class Fem(Options):
    """Linear elements have no options."""


@register("operator", "fem")
def fem_operator(options: Fem, *, surface: Surface) -> SurfaceOperator:
    """Piecewise linear finite elements: gradient on faces, divergence its exact negative adjoint."""
    return fem(surface.mesh)
