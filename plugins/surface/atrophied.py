"""A surface with a planted loss of tissue, section 4.5."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.populations.atrophy import with_atrophy

METRICS = {
    "tissue_lost": Metric("planted loss of volume, share"),
}


register(
    "surface",
    "atrophied",
    metrics=METRICS,
    options={
        "depth": Field(1.0, ge=0, le=100, description="depth of the dent at the tip, unit of length"),
        "reach": Field(gt=0, le=2, description="reach of the dent, share of the longest axis"),
    },
    names={"surface": "original"},
)(with_atrophy)
