"""The cingulate gyri of figures 5.1, 5.3, 5.4 and 5.8."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.studies.cingulate.average_cingulate import cingulate


@register("surface", "cingulate", defaults_of=cingulate)
def cingulate_surface(
    *,
    hemisphere: Annotated[Literal["left", "right"], Field(description="hemisphere of the brain")],
    sheet: Annotated[Literal["white", "pial", "inflated"], Field(description="which of the nested surfaces")],
    refine: Annotated[int, Field(ge=0, le=3, description="how often each face is divided in four")],
    jag: Annotated[float, Field(ge=0, le=0.9, description="share of the boundary's faces taken off at random")],
    seed: Annotated[int, Field(ge=0, description="seed of what is taken off")],
    mirror: Annotated[bool, Field(description="reflect in the midline, so that right gyri are as left ones")],
) -> Surface:
    """Cingulate gyrus of fsaverage5 by its Desikan-Killiany labels, an open patch with a jagged edge, in mm."""
    return cingulate(hemisphere=hemisphere, sheet=sheet, refine=refine, jag=jag, seed=seed, mirror=mirror)
