"""Total variation denoising (2.6)."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.variational.model import Model
from surfexp.variational.models.rof import ROF
from surfexp.variational.truth_metrics import RESTORATION_METRICS


class RofOptions(Options):
    """The weight of the data."""

    w: float = Field(0.9, gt=0, description="weight without unit, w = mu sigma h")
    mu: float | None = Field(None, gt=0, description="the published weight in place of w")


@register("model", "rof", metrics=RESTORATION_METRICS)
def rof_model(options: RofOptions) -> Model:
    """min TV(phi) + mu/2 |phi - I|^2, the model of Rudin, Osher and Fatemi (2.6)."""
    return ROF(w=options.w, mu=options.mu)
