"""Denoising by total generalised variation of second order."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.variational.models.tgv import TGV
from surfexp.variational.truth_metrics import RESTORATION_METRICS


@register("model", "tgv", metrics=RESTORATION_METRICS, defaults_of=TGV)
def tgv_model(
    *,
    w: Annotated[float, Field(gt=0, description="weight without unit, w = mu sigma h")],
    mu: Annotated[float | None, Field(gt=0, description="the weight itself in place of w")],
    ratio: Annotated[float, Field(gt=0, description="length over which a slope may turn, in edge lengths")],
) -> TGV:
    """min over u and w of int |grad u - w| + ratio h |D w| + mu/2 |u - I|^2: edges stay, and slopes."""
    return TGV(w=w, mu=mu, ratio=ratio)
