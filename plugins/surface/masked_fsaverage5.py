"""The average human cortex without its medial wall."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.lab.registry.registry import register
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface


@register("surface", "masked_fsaverage5", defaults_of=fsaverage5)
def masked_fsaverage5_surface(
    *,
    hemisphere: Annotated[Literal["left", "right"], Field(description="hemisphere of the brain")],
    sheet: Annotated[Literal["pial", "white", "inflated"], Field(description="which of the nested surfaces")] = "white",
) -> Surface:
    """One hemisphere of fsaverage5 where its cortex has a thickness: a surface with a boundary around the medial wall."""
    surface = fsaverage5(hemisphere, sheet)
    return cut_to_mask(surface, surface.scalars["thickness"] > 0)
