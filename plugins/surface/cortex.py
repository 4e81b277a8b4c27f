"""Cortex-like surfaces for table 2.2."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.cortex import cortex

register(
    "surface",
    "cortex",
    options={
        "form": Field(description="smooth stands for M1, folded for M2"),
        "count": Field(ge=10000, le=400000, description="number of vertices"),
        "seed": Field(ge=0, description="another field of sulci"),
    },
)(cortex)
