"""Finite elements on the intrinsic Delaunay triangulation."""

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay

METRICS = {
    "flips": Metric("edges that were flipped"),
    "mollification": Metric("length added to every edge", "unit of length"),
}

register(
    "operator",
    "intrinsic_delaunay",
    summary="Finite elements after intrinsic edge flips; survives slivers and mild non-manifoldness.",
    options={},
    metrics=METRICS,
)(intrinsic_delaunay)
