"""The average human cortex without its medial wall."""

from typing import Literal

from pydantic import Field

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface


class MaskedFsaverage5(Options):
    """Which hemisphere and which of its surfaces."""

    hemisphere: Literal["left", "right"] = Field("left", description="hemisphere of the brain")
    sheet: Literal["pial", "white", "inflated"] = Field("white", description="which of the nested surfaces")


@register("surface", "masked_fsaverage5")
def masked_fsaverage5_surface(options: MaskedFsaverage5) -> Surface:
    """One hemisphere of fsaverage5 where its cortex has a thickness: a surface with a boundary around the medial wall."""
    surface = fsaverage5(options.hemisphere, options.sheet)
    return cut_to_mask(surface, surface.scalars["thickness"] > 0)
