"""Finite elements on the intrinsic Delaunay triangulation."""

from surfexp.mesh.surface import Surface
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.workflow.registry import Options, register


class IntrinsicDelaunay(Options):
    """The intrinsic triangulation has no options."""


@register("operator", "intrinsic_delaunay")
def intrinsic_delaunay_operator(options: IntrinsicDelaunay, *, surface: Surface) -> SurfaceOperator:
    """Finite elements after intrinsic edge flips; survives slivers and mild non-manifoldness."""
    return intrinsic_delaunay(surface.mesh)
