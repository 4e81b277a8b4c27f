"""All spectral signatures of a surface in one stage, for collections."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.spectrum.signature import Signature
from surfexp.spectrum.spectral_signature import spectral_signature

TRIANGULATIONS = {"fem": fem, "intrinsic_delaunay": intrinsic_delaunay}


METRICS = {
    "complete": Metric("1 where it is proved that no eigenvalue is missing, else 0", better="higher"),
    "largest_residual": Metric("largest relative residual of the pairs", better="lower"),
    "area": Metric("area", "unit of length squared"),
    "edge_length": Metric("mean length of the edges", "unit of length"),
    "courant_violations": Metric("modes with more domains than Courant's bound", better="lower"),
    "trusted_modes": Metric("modes whose counts the mesh resolves"),
    "mean_count_ratio": Metric("mean of count over number of the mode"),
}


@register("signature", "spectral", metrics=METRICS, defaults_of=spectral_signature)
def spectral(
    surface: Surface,
    *,
    count: Annotated[int, Field(ge=8, le=2000, description="modes after the constant one")],
    order: Annotated[Literal[1, 2, 3], Field(description="order of the elements")],
    triangulation: Annotated[
        Literal["fem", "intrinsic_delaunay"], Field(description="triangles of the elements")
    ] = "fem",
    seed: Annotated[int, Field(ge=0, description="seed of starting vectors and of drawn points")],
) -> Signature:
    """Shape DNA, nodal counts, heat trace, HKS, WKS, GPS distances and area in one stage, each a part by name."""
    operator = TRIANGULATIONS[triangulation](surface.mesh)
    return spectral_signature(surface, operator, count, order, seed)
