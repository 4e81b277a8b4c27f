"""All descriptors of a study of fingerprints, by two routes."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.fingerprints.descriptors import fingerprint

METRICS = {
    "complete": Metric("1 where it is proved that no eigenvalue is missing, else 0", better="higher"),
    "largest_residual": Metric("largest relative residual of the certified pairs", better="lower"),
    "area": Metric("area", "unit of length squared"),
    "vertices": Metric("number of vertices"),
}


register(
    "signature",
    "fingerprint",
    metrics=METRICS,
    options={
        "count": Field(ge=50, le=2000, description="modes after the constant one"),
        "seed": Field(ge=0, description="seed of the start vectors"),
    },
)(fingerprint)
