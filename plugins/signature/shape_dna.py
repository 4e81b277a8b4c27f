"""The spectrum as a signature, section 4.2."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.enclosed_volume import enclosed_volume
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.shape_dna import shape_dna
from surfexp.spectrum.signature import Signature

METRICS = {
    "first": Metric("first entry"),
    "last": Metric("last entry"),
    "complete": Metric("1 where it is proved that no eigenvalue is missing, else 0", better="higher"),
}


@register("signature", "shape_dna", metrics=METRICS, defaults_of=shape_dna)
def shape_dna_signature(
    surface: Surface,
    eigensolver: EigenSystem,
    *,
    normalisation: Annotated[
        Literal["raw", "area", "volume", "first", "slope"], Field(description="what divides out size")
    ],
    count: Annotated[
        int,
        Field(
            ge=1,
            le=5000,
            description="most values that are kept; 35 with weights 1/n found kinds best, see docs/defaults.md",
        ),
    ] = 35,
    reweighted: Annotated[
        bool,
        Field(description="divide the n-th value by n already here; distance_matrix/signatures does so by alpha = 1"),
    ],
) -> Signature:
    """The first eigenvalues after the zero ones, raw or independent of size (shape DNA)."""
    volume = abs(enclosed_volume(surface.mesh)) if surface.mesh.is_closed else None
    values = shape_dna(eigensolver.values, normalisation, eigensolver.area, volume, reweighted)
    values = values[:count]
    metrics = {"first": float(values[0]), "last": float(values[-1]), "complete": float(eigensolver.complete)}
    return Signature(values, "shape_dna", metrics=metrics, notes=eigensolver.notes)
