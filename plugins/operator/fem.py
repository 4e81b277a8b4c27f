"""Per-face gradients with their exact adjoint."""

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator


@register("operator", "fem")
def fem_operator(surface: Surface) -> SurfaceOperator:
    """Piecewise linear finite elements: gradient on faces, divergence its exact negative adjoint."""
    return fem(surface.mesh)
