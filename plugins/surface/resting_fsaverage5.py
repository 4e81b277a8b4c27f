"""The part of the average cortex on which a run at rest is known."""

from typing import Literal

from pydantic import Field

from surfexp.anatomy.resting_run import resting_fsaverage5
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface


class RestingFsaverage5(Options):
    """Which hemisphere and which of its surfaces."""

    hemisphere: Literal["left", "right"] = Field("left", description="hemisphere of the brain")
    sheet: Literal["pial", "white", "inflated"] = Field("white", description="which of the nested surfaces")


@register("surface", "resting_fsaverage5")
def resting_fsaverage5_surface(options: RestingFsaverage5) -> Surface:
    """One hemisphere of fsaverage5 where a run at rest varies: without the medial wall; needs brainspace 0.3.0."""
    return resting_fsaverage5(options.hemisphere, options.sheet)
