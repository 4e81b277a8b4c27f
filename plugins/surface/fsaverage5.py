"""The average human cortex, with FreeSurfer's maps."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface


@register("surface", "fsaverage5", defaults_of=fsaverage5)
def fsaverage5_surface(
    *,
    hemisphere: Annotated[Literal["left", "right"], Field(description="hemisphere of the brain")],
    sheet: Annotated[
        Literal["pial", "white", "inflated", "sphere"], Field(description="which of the four nested surfaces")
    ] = "white",
) -> Surface:
    """One hemisphere of the fsaverage5 cortex: 10,242 vertices, closed, genus 0, in mm."""
    return fsaverage5(hemisphere, sheet)
