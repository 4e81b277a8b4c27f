"""Total variation denoising of colours and coordinates."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.variational.model import Model
from surfexp.variational.models.rof import ROF
from surfexp.variational.truth_metrics import RESTORATION_METRICS


class VectorialRof(Options):
    """The weight of the data, and whether the channels are coupled."""

    w: float = Field(0.9, gt=0, description="weight without unit, w = mu sigma h")
    mu: float | None = Field(None, gt=0, description="the published weight in place of w")
    scheme: Literal["sound", "as_published"] = Field(
        "sound", description="sound: channels share the norm of their gradient; as_published: each on its own"
    )


@register("model", "vectorial_rof", metrics=RESTORATION_METRICS)
def vectorial_rof_model(options: VectorialRof) -> Model:
    """ROF with the rotation-invariant total variation of several channels; or channel by channel, as published."""
    return ROF(w=options.w, mu=options.mu, by_channel=options.scheme == "as_published")
