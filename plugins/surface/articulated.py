"""Poses of generated bodies, section 4.4."""

from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.populations.articulated import articulated_body


class Articulated(Options):
    """Which body, and how it stands."""

    body: Literal["biped", "heavy_biped", "quadruped", "long_neck", "octopod", "worm"] = Field(
        "biped", description="kind of body"
    )
    pose: int = Field(0, ge=0, le=1000000, description="seed of the turns of its joints; 0 is the pose at rest")
    bending: float = Field(1.0, ge=0, le=3, description="factor of all turns")
    vertices: int = Field(2000, ge=400, le=200000, description="number of vertices")


METRICS = {
    "area_change": Metric("area over that of the rest pose, less one"),
}


@register("surface", "articulated", metrics=METRICS)
def articulated(options: Articulated) -> Surface:
    """A body with bones in one of many nearly isometric poses, closed, genus 0."""
    return articulated_body(**dict(options))
