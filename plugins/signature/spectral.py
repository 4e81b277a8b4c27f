"""All spectral signatures of a surface in one stage, for collections."""

from typing import Literal

from pydantic import Field

from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.spectrum.signature import Signature
from surfexp.spectrum.spectral_signature import spectral_signature
from surfexp.workflow.registry import Options, register

TRIANGULATIONS = {"fem": fem, "intrinsic_delaunay": intrinsic_delaunay}


class Spectral(Options):
    """How many modes, and with which elements."""

    count: int = Field(100, ge=8, le=2000, description="modes after the constant one")
    order: Literal[1, 2, 3] = Field(1, description="order of the elements")
    triangulation: Literal["fem", "intrinsic_delaunay"] = Field("fem", description="triangles of the elements")
    seed: int = Field(0, ge=0, description="seed of starting vectors and of drawn points")


@register("signature", "spectral")
def spectral(options: Spectral, *, surface: Surface) -> Signature:
    """Shape DNA, nodal counts, heat trace, HKS, WKS, GPS distances and area in one stage, each a part by name."""
    operator = TRIANGULATIONS[options.triangulation](surface.mesh)
    return spectral_signature(surface, operator, options.count, options.order, options.seed)
