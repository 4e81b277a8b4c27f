"""The part of the average cortex on which a run at rest is known."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.resting_run import resting_fsaverage5
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface


@register("surface", "resting_fsaverage5", defaults_of=resting_fsaverage5)
def resting_fsaverage5_surface(
    *,
    hemisphere: Annotated[Literal["left", "right"], Field(description="hemisphere of the brain")],
    sheet: Annotated[Literal["pial", "white", "inflated"], Field(description="which of the nested surfaces")],
) -> Surface:
    """One hemisphere of fsaverage5 where a run at rest varies: without the medial wall; needs brainspace 0.3.0."""
    return resting_fsaverage5(hemisphere, sheet)
