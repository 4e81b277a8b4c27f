"""The average human cortex with the names of its gyri."""

from dataclasses import replace
from typing import Literal

from pydantic import Field

from surfexp.embedding.labels import LABEL, desikan_killiany
from surfexp.mesh.fsaverage5 import fsaverage5
from surfexp.mesh.surface import Surface
from surfexp.workflow.registry import Options, register


class LabelledFsaverage5(Options):
    """Which of the surfaces."""

    hemisphere: Literal["left", "right"] = Field("left", description="hemisphere of the brain")
    sheet: Literal["pial", "white", "inflated"] = Field("white", description="which of the nested surfaces")


@register("surface", "labelled_fsaverage5")
def labelled_fsaverage5_surface(options: LabelledFsaverage5) -> Surface:
    """One hemisphere of fsaverage5 with the scalar map "label", the 35 Desikan-Killiany regions."""
    surface = fsaverage5(options.hemisphere, options.sheet)
    labels = desikan_killiany(options.hemisphere).astype(float)
    return replace(surface, scalars={**surface.scalars, LABEL: labels})
