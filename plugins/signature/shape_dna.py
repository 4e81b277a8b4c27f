"""The spectrum as a signature, section 4.2."""

from typing import Literal

from pydantic import Field

from surfexp.anatomy.enclosed_volume import enclosed_volume
from surfexp.mesh.surface import Surface
from surfexp.metric import Metric
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.shape_dna import shape_dna
from surfexp.spectrum.signature import Signature
from surfexp.workflow.registry import Options, register


class ShapeDna(Options):
    """How eigenvalues become independent of size."""

    normalisation: Literal["raw", "area", "volume", "first", "slope"] = Field(
        "area", description="what divides out size"
    )
    reweighted: bool = Field(False, description="divide the n-th value by n")


METRICS = {
    "first": Metric("first entry"),
    "last": Metric("last entry"),
    "complete": Metric("1 where no eigenvalue is proved to be missing, else 0", better="higher"),
}


@register("signature", "shape_dna", metrics=METRICS)
def shape_dna_signature(options: ShapeDna, *, surface: Surface, eigensolver: EigenSystem) -> Signature:
    """Eigenvalues after the zero ones, raw or independent of size (shape DNA)."""
    volume = abs(enclosed_volume(surface.mesh)) if surface.mesh.is_closed else None
    values = shape_dna(eigensolver.values, options.normalisation, eigensolver.area, volume, options.reweighted)
    metrics = {"first": float(values[0]), "last": float(values[-1]), "complete": float(eigensolver.complete)}
    return Signature(values, "shape_dna", metrics=metrics, notes=eigensolver.notes)
