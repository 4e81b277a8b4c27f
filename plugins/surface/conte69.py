"""The average cortex of the fsLR mesh, with measured maps."""

from typing import Literal

from pydantic import Field

from surfexp.anatomy.conte69 import conte69
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface


class Conte69(Options):
    """Which hemisphere and which of its surfaces."""

    hemisphere: Literal["left", "right"] = Field("left", description="hemisphere of the brain")
    sheet: Literal["midthickness", "sphere"] = Field("midthickness", description="which of the nested surfaces")


@register("surface", "conte69")
def conte69_surface(options: Conte69) -> Surface:
    """One hemisphere of conte69 (fsLR, 32k) without its medial wall, with seven measured maps; needs brainspace 0.3.0."""
    return conte69(options.hemisphere, options.sheet)
