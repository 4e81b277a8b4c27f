"""The cube of figure 2.7."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.cube import cube

register(
    "surface",
    "cube",
    options={
        "cells": Field(ge=1, le=400, description="squares along a side"),
        "side": Field(gt=0, description="side length"),
        "rotation": Field(description="degrees about x, then y, then z"),
    },
)(cube)
