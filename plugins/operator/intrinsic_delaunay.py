"""Finite elements on the intrinsic Delaunay triangulation."""

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.operators.surface_operator import SurfaceOperator

METRICS = {
    "flips": Metric("edges that were flipped"),
    "mollification": Metric("length added to every edge", "unit of length"),
}


@register("operator", "intrinsic_delaunay", metrics=METRICS)
def intrinsic_delaunay_operator(surface: Surface) -> SurfaceOperator:
    """Finite elements after intrinsic edge flips; survives slivers and mild non-manifoldness."""
    return intrinsic_delaunay(surface.mesh)
