"""BrainPrint, through LaPy."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.spectrum.brainprint import brainprint

METRICS = {
    "first": Metric("first entry"),
    "last": Metric("last entry"),
}

register(
    "signature",
    "brainprint",
    summary="Shape DNA by LaPy, times the area and over the number of each value, as BrainPrint takes it.",
    options={"count": Field(ge=1, le=2000, description="eigenvalues after 0")},
    metrics=METRICS,
)(brainprint)
