"""The average cortex of the fsLR mesh, with measured maps."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.conte69 import conte69
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface


@register("surface", "conte69", defaults_of=conte69)
def conte69_surface(
    *,
    hemisphere: Annotated[Literal["left", "right"], Field(description="hemisphere of the brain")],
    sheet: Annotated[Literal["midthickness", "sphere"], Field(description="which of the nested surfaces")],
) -> Surface:
    """One hemisphere of conte69 (fsLR, 32k) without its medial wall, with seven measured maps; needs brainspace 0.3.0."""
    return conte69(hemisphere, sheet)
