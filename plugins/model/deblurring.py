"""Total variation deblurring (2.7)."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.variational.model import Model
from surfexp.variational.models.deblurring import Deblurring
from surfexp.variational.truth_metrics import RESTORATION_METRICS


@register("model", "deblurring", metrics=RESTORATION_METRICS, defaults_of=Deblurring)
def deblurring_model(
    *,
    width: Annotated[float, Field(gt=0, le=100, description="standard deviation of the blur in edge lengths")],
    w: Annotated[float, Field(gt=0, description="weight without unit, w = mu sigma h")],
    mu: Annotated[float | None, Field(gt=0, description="the published weight in place of w; needed without noise")],
) -> Model:
    """min TV(phi) + mu/2 |K phi - I|^2, K a step of heat diffusion (2.7)."""
    return Deblurring(width=width, w=w, mu=mu)
