"""Operators assembled by libigl."""

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.libigl_operator import libigl_operator
from surfexp.operators.surface_operator import SurfaceOperator


@register("operator", "libigl")
def libigl_backend(surface: Surface) -> SurfaceOperator:
    """Gradient, cotangent weights and mass from libigl; agrees with fem to rounding."""
    return libigl_operator(surface.mesh)
