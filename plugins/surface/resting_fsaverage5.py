"""The part of the average cortex on which a run at rest is known."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.resting_run import resting_fsaverage5
from surfexp.lab.registry.registry import register

register(
    "surface",
    "resting_fsaverage5",
    options={
        "hemisphere": Field(description="hemisphere of the brain"),
        "sheet": Annotated[Literal["pial", "white", "inflated"], Field(description="which of the nested surfaces")],
    },
)(resting_fsaverage5)
