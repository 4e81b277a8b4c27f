"""Total variation inpainting (2.8)."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.variational.model import Model
from surfexp.variational.models.inpainting import Inpainting
from surfexp.variational.truth_metrics import RESTORATION_METRICS


@register("model", "inpainting", metrics=RESTORATION_METRICS, defaults_of=Inpainting)
def inpainting_model(
    *,
    w: Annotated[float, Field(gt=0, description="weight without unit, w = mu sigma h")],
    mu: Annotated[float | None, Field(gt=0, description="the published weight in place of w; needed without noise")],
) -> Model:
    """min TV(phi) + mu/2 |phi - I|^2 over the known part of the image, values within its range (2.8)."""
    return Inpainting(w=w, mu=mu)
