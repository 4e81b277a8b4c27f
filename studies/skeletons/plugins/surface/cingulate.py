"""The cingulate gyri of figures 5.1, 5.3, 5.4 and 5.8."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp_studies.skeletons.average_cingulate import cingulate

register(
    "surface",
    "cingulate",
    options={
        "hemisphere": Field(description="hemisphere of the brain"),
        "sheet": Annotated[Literal["white", "pial", "inflated"], Field(description="which of the nested surfaces")],
        "refine": Field(ge=0, le=3, description="how often each face is divided in four"),
        "jag": Field(ge=0, le=0.9, description="share of the boundary's faces taken off at random"),
        "seed": Field(ge=0, description="seed of what is taken off"),
        "mirror": Field(description="reflect in the midline, so that right gyri are as left ones"),
    },
)(cingulate)
