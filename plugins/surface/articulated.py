"""Poses of generated bodies, section 4.4."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.populations.articulated import articulated_body

METRICS = {
    "area_change": Metric("area over that of the rest pose, less one"),
}


@register("surface", "articulated", metrics=METRICS, defaults_of=articulated_body)
def articulated(
    *,
    body: Annotated[
        Literal["biped", "heavy_biped", "quadruped", "long_neck", "octopod", "worm"], Field(description="kind of body")
    ],
    pose: Annotated[int, Field(ge=0, le=1000000, description="seed of the turns of its joints; 0 is the pose at rest")],
    bending: Annotated[float, Field(ge=0, le=3, description="factor of all turns")],
    vertices: Annotated[int, Field(ge=400, le=200000, description="number of vertices")],
) -> Surface:
    """A body with bones in one of many nearly isometric poses, closed, genus 0."""
    return articulated_body(body=body, pose=pose, bending=bending, vertices=vertices)
