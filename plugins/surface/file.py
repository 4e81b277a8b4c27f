"""A surface of your own."""

from pathlib import Path
from typing import Any

import numpy as np
from pydantic import Field, model_validator

from surfexp.io.map_files import read_scalars
from surfexp.io.tosca import shape_files
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface
from surfexp.tasks.files import read
from surfexp.tasks.soundness import usable_vertices


class File(Options):
    """The file, what belongs to its vertices, and the part of it that methods work on."""

    path: Path = Field(description="OFF, OBJ, PLY, STL, VTK, GIFTI, FreeSurfer geometry, .vert/.tri; others by open3d")
    unit: str = Field("", description="unit of length, for captions")
    faces: Path | None = Field(None, description="the .tri beside a .vert, found by itself")
    maps: dict[str, Path] = Field({}, description="maps by name, such as a reference: {sulc: lh.sulc}")
    labels: dict[str, Path] = Field({}, description=".label.gii, .annot or .dlabel.nii by name")
    mask: Path | None = Field(None, description="part to keep: a .label, named labels, or a map that is 0 outside")
    mask_names: tuple[str, ...] = Field((), description="labels to keep; default: all but unknown and medial wall")
    finite: Path | None = Field(None, description="a map that is NaN where the surface is to be cut away")

    @model_validator(mode="before")
    @classmethod
    def _both_tables(cls, given: dict[str, Any]) -> dict[str, Any]:
        known = "path" in given and Path(given["path"]).is_file()
        return {**given, "faces": shape_files(Path(given["path"]))[1]} if known else given


@register("surface", "file")
def file_surface(options: File) -> Surface:
    """A mesh file of your own with its maps, cut down to a mask; refused with the repair command when defective."""
    names = f":{','.join(options.mask_names)}" if options.mask_names else ""
    mask = None if options.mask is None else f"{options.mask}{names}"
    surface = read(options.path, maps=options.maps, labels=options.labels, mask=mask, unit=options.unit)
    inside = surface.mask
    if options.finite is not None:
        finite = np.isfinite(read_scalars(options.finite))
        if finite.shape != (len(surface.mesh.vertices),):
            raise ValueError(
                f"{options.finite} has {finite.size} values, the surface has {len(surface.mesh.vertices)} vertices"
            )
        inside = finite if inside is None else inside & finite
    usable = usable_vertices(surface.mesh)
    if not usable.all():
        inside = usable if inside is None else inside & usable
    return cut_to_mask(surface, inside)
