"""All descriptors of a study of fingerprints, by two routes."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.signature import Signature
from surfexp.studies.fingerprints.descriptors import fingerprint


class Fingerprint(Options):
    """How many modes."""

    count: int = Field(100, ge=50, le=2000, description="modes after the constant one")
    seed: int = Field(0, ge=0, description="seed of the start vectors")


METRICS = {
    "complete": Metric("1 where no eigenvalue is proved to be missing, else 0", better="higher"),
    "largest_residual": Metric("largest relative residual of the certified pairs", better="lower"),
    "area": Metric("area", "unit of length squared"),
    "vertices": Metric("number of vertices"),
}


@register("signature", "fingerprint", metrics=METRICS)
def fingerprint_signature(options: Fingerprint, *, surface: Surface) -> Signature:
    """Descriptors of a closed surface from a certified spectrum and from ARPACK as LaPy calls it, with certificates."""
    return fingerprint(surface, options.count, options.seed)
