"""The average human cortex with the names of its gyri, or labels of one's own."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.embedding.labels import desikan_killiany
from surfexp.io.label_files import read_labels
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface


@register("surface", "labelled_fsaverage5", defaults_of=fsaverage5)
def labelled_fsaverage5_surface(
    *,
    hemisphere: Annotated[Literal["left", "right"], Field(description="hemisphere of the brain")],
    sheet: Annotated[Literal["pial", "white", "inflated"], Field(description="which of the nested surfaces")] = "white",
    labels: Annotated[
        Path | None,
        Field(
            description=".annot or .label.gii with one label a vertex, such as Destrieux's; default: Desikan-Killiany"
        ),
    ] = None,
) -> Surface:
    """One hemisphere of fsaverage5 with true labels: the 35 Desikan-Killiany regions, or those of a file."""
    surface = fsaverage5(hemisphere, sheet)
    if labels is None:
        found = desikan_killiany(hemisphere)
    else:
        found = read_labels(labels)[0]
        count = len(surface.mesh.vertices)
        if len(found) != count:
            raise ValueError(f"{labels} has {len(found)} labels, {surface.name} has {count} vertices")
    return replace(surface, truth=replace(surface.truth, labels=found))
