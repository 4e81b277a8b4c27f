"""Total variation deblurring (2.7)."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.variational.model import Model
from surfexp.variational.models.deblurring import Deblurring
from surfexp.variational.truth_metrics import RESTORATION_METRICS


class DeblurringOptions(Options):
    """The weight of the data, and the width of the blur."""

    width: float = Field(2.0, gt=0, le=100, description="standard deviation of the blur in edge lengths")
    w: float = Field(0.9, gt=0, description="weight without unit, w = mu sigma h")
    mu: float | None = Field(None, gt=0, description="the published weight in place of w; needed without noise")


@register("model", "deblurring", metrics=RESTORATION_METRICS)
def deblurring_model(options: DeblurringOptions) -> Model:
    """min TV(phi) + mu/2 |K phi - I|^2, K a step of heat diffusion (2.7)."""
    return Deblurring(**dict(options))
