"""Total variation denoising (2.6)."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.variational.model import Model
from surfexp.variational.models.rof import ROF
from surfexp.variational.truth_metrics import RESTORATION_METRICS


@register("model", "rof", metrics=RESTORATION_METRICS, defaults_of=ROF)
def rof_model(
    *,
    w: Annotated[float, Field(gt=0, description="weight without unit, w = mu sigma h")],
    mu: Annotated[float | None, Field(gt=0, description="the published weight in place of w")],
) -> Model:
    """min TV(phi) + mu/2 |phi - I|^2, the model of Rudin, Osher and Fatemi (2.6)."""
    return ROF(w=w, mu=mu)
