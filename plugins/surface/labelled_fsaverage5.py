"""The average human cortex with the names of its gyri, or labels of one's own."""

from dataclasses import replace
from pathlib import Path
from typing import Literal

from pydantic import Field

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.embedding.labels import desikan_killiany
from surfexp.io.label_files import read_labels
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface


class LabelledFsaverage5(Options):
    """Which of the surfaces."""

    hemisphere: Literal["left", "right"] = Field("left", description="hemisphere of the brain")
    sheet: Literal["pial", "white", "inflated"] = Field("white", description="which of the nested surfaces")
    labels: Path | None = Field(
        None, description=".annot or .label.gii with one label a vertex, such as Destrieux's; default: Desikan-Killiany"
    )


@register("surface", "labelled_fsaverage5")
def labelled_fsaverage5_surface(options: LabelledFsaverage5) -> Surface:
    """One hemisphere of fsaverage5 with true labels: the 35 Desikan-Killiany regions, or those of a file."""
    surface = fsaverage5(options.hemisphere, options.sheet)
    if options.labels is None:
        labels = desikan_killiany(options.hemisphere)
    else:
        labels = read_labels(options.labels)[0]
        count = len(surface.mesh.vertices)
        if len(labels) != count:
            raise ValueError(f"{options.labels} has {len(labels)} labels, {surface.name} has {count} vertices")
    return replace(surface, truth=replace(surface.truth, labels=labels))
