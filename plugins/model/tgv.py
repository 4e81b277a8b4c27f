"""Denoising by total generalised variation of second order."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.variational.models.tgv import TGV
from surfexp.variational.truth_metrics import RESTORATION_METRICS


class TgvOptions(Options):
    """The weight of the data, and over what length a slope may turn."""

    w: float = Field(0.9, gt=0, description="weight without unit, w = mu sigma h")
    mu: float | None = Field(None, gt=0, description="the weight itself in place of w")
    ratio: float = Field(2.0, gt=0, description="length over which a slope may turn, in edge lengths")


@register("model", "tgv", metrics=RESTORATION_METRICS)
def tgv_model(options: TgvOptions) -> TGV:
    """min over u and w of int |grad u - w| + ratio h |D w| + mu/2 |u - I|^2: edges stay, and slopes."""
    return TGV(w=options.w, mu=options.mu, ratio=options.ratio)
