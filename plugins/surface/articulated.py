"""Poses of generated bodies, section 4.4."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.populations.articulated import articulated_body

METRICS = {
    "area_change": Metric("area over that of the rest pose, less one"),
}


register(
    "surface",
    "articulated",
    metrics=METRICS,
    options={
        "body": Annotated[
            Literal["biped", "heavy_biped", "quadruped", "long_neck", "octopod", "worm"],
            Field(description="kind of body"),
        ],
        "pose": Field(ge=0, le=1000000, description="seed of the turns of its joints; 0 is the pose at rest"),
        "bending": Field(ge=0, le=3, description="factor of all turns"),
        "vertices": Field(ge=400, le=200000, description="number of vertices"),
    },
)(articulated_body)
