"""The average cortex of the fsLR mesh, with measured maps."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.conte69 import conte69
from surfexp.lab.registry.registry import register

register(
    "surface",
    "conte69",
    options={
        "hemisphere": Annotated[Literal["left", "right"], Field(description="hemisphere of the brain")],
        "sheet": Annotated[Literal["midthickness", "sphere"], Field(description="which of the nested surfaces")],
    },
)(conte69)
