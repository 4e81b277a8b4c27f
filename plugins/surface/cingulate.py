"""The cingulate gyri of figures 5.1, 5.3, 5.4 and 5.8."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.studies.cingulate.average_cingulate import cingulate


class Cingulate(Options):
    """One cingulate gyrus."""

    hemisphere: Literal["left", "right"] = Field("left", description="hemisphere of the brain")
    sheet: Literal["white", "pial", "inflated"] = Field("white", description="which of the nested surfaces")
    refine: int = Field(1, ge=0, le=3, description="how often each face is divided in four")
    jag: float = Field(0.0, ge=0, le=0.9, description="share of the boundary's faces taken off at random")
    seed: int = Field(0, ge=0, description="seed of what is taken off")
    mirror: bool = Field(False, description="reflect in the midline, so that right gyri are as left ones")


@register("surface", "cingulate")
def cingulate_surface(options: Cingulate) -> Surface:
    """Cingulate gyrus of fsaverage5 by its Desikan-Killiany labels, an open patch with a jagged edge, in mm."""
    return cingulate(**dict(options))
