"""Total variation inpainting (2.8)."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.variational.model import Model
from surfexp.variational.models.inpainting import Inpainting
from surfexp.variational.truth_metrics import RESTORATION_METRICS


class InpaintingOptions(Options):
    """The weight of the data."""

    w: float = Field(0.9, gt=0, description="weight without unit, w = mu sigma h")
    mu: float | None = Field(None, gt=0, description="the published weight in place of w; needed without noise")


@register("model", "inpainting", metrics=RESTORATION_METRICS)
def inpainting_model(options: InpaintingOptions) -> Model:
    """min TV(phi) + mu/2 |phi - I|^2 over the known part of the image, values within its range (2.8)."""
    return Inpainting(w=options.w, mu=options.mu)
