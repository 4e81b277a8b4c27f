"""Total variation denoising of colours and coordinates."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.variational.model import Model
from surfexp.variational.models.rof import ROF
from surfexp.variational.truth_metrics import RESTORATION_METRICS


@register("model", "vectorial_rof", metrics=RESTORATION_METRICS, defaults_of=ROF)
def vectorial_rof_model(
    *,
    weight: Annotated[float, Field(gt=0, description="weight without unit, mu sigma h")],
    mu: Annotated[float | None, Field(gt=0, description="the published weight in place of weight")],
    scheme: Annotated[
        Literal["sound", "as_published"],
        Field(description="sound: channels share the norm of their gradient; as_published: each on its own"),
    ] = "sound",
) -> Model:
    """ROF with the rotation-invariant total variation of several channels; or channel by channel, as published."""
    return ROF(weight=weight, mu=mu, by_channel=scheme == "as_published")
