"""All descriptors of a study of fingerprints, by two routes."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.signature import Signature
from surfexp.studies.fingerprints.descriptors import fingerprint

METRICS = {
    "complete": Metric("1 where no eigenvalue is proved to be missing, else 0", better="higher"),
    "largest_residual": Metric("largest relative residual of the certified pairs", better="lower"),
    "area": Metric("area", "unit of length squared"),
    "vertices": Metric("number of vertices"),
}


@register("signature", "fingerprint", metrics=METRICS, defaults_of=fingerprint)
def fingerprint_signature(
    surface: Surface,
    *,
    count: Annotated[int, Field(ge=50, le=2000, description="modes after the constant one")],
    seed: Annotated[int, Field(ge=0, description="seed of the start vectors")],
) -> Signature:
    """Descriptors of a closed surface from a certified spectrum and from ARPACK as LaPy calls it, with certificates."""
    return fingerprint(surface, count, seed)
