"""The average human cortex, with FreeSurfer's maps."""

from typing import Literal

from pydantic import Field

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface


class Fsaverage5(Options):
    """Which hemisphere and which of its surfaces."""

    hemisphere: Literal["left", "right"] = Field("left", description="hemisphere of the brain")
    sheet: Literal["pial", "white", "inflated", "sphere"] = Field(
        "white", description="which of the four nested surfaces"
    )


@register("surface", "fsaverage5")
def fsaverage5_surface(options: Fsaverage5) -> Surface:
    """One hemisphere of the fsaverage5 cortex: 10,242 vertices, closed, genus 0, in mm."""
    return fsaverage5(options.hemisphere, options.sheet)
