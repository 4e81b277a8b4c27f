"""A surface of your own."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field, ValidationInfo

from surfexp.io.map_files import read_scalars
from surfexp.io.tosca import shape_files
from surfexp.lab.registry.registry import register
from surfexp.mesh.length_scale import LARGE, SMALL, length_scale
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface
from surfexp.tasks.files import read
from surfexp.tasks.soundness import usable_vertices


def _triangles(given: Path | None, info: ValidationInfo) -> Path | None:
    path = info.data.get("path")
    return shape_files(path)[1] if path is not None and path.is_file() else given


@register("surface", "file", defaults_of=read)
def file_surface(
    *,
    path: Annotated[
        Path, Field(description="OFF, OBJ, PLY, STL, VTK, GIFTI, FreeSurfer geometry, .vert/.tri; others by open3d")
    ],
    unit: Annotated[str, Field(description="unit of length, for captions")],
    faces: Annotated[
        Path | None, AfterValidator(_triangles), Field(description="the .tri beside a .vert, found by itself")
    ] = None,
    maps: Annotated[Mapping[str, Path], Field(description="maps by name, such as a reference: {sulc: lh.sulc}")] = {},
    labels: Annotated[Mapping[str, Path], Field(description=".label.gii, .annot or .dlabel.nii by name")] = {},
    mask: Annotated[Path | None, Field(description="part to keep: a .label, named labels, or a map that is 0 outside")],
    mask_names: Annotated[
        tuple[str, ...], Field(description="labels to keep; default: all but unknown and medial wall")
    ] = (),
    finite: Annotated[Path | None, Field(description="a map that is NaN where the surface is to be cut away")] = None,
) -> Surface:
    """A mesh file of your own with its maps, cut down to a mask; refused with the repair command when defective."""
    names = f":{','.join(mask_names)}" if mask_names else ""
    mask_source = None if mask is None else f"{mask}{names}"
    surface = read(path, maps=maps, labels=labels, mask=mask_source, unit=unit)
    if length_scale(surface.mesh.vertices) != 1.0:
        raise ValueError(f"{path} has a largest coordinate outside of {SMALL:g} to {LARGE:g}: change the unit")
    inside = surface.mask
    if finite is not None:
        is_finite = np.isfinite(read_scalars(finite))
        if is_finite.shape != (len(surface.mesh.vertices),):
            raise ValueError(
                f"{finite} has {is_finite.size} values, the surface has {len(surface.mesh.vertices)} vertices"
            )
        inside = is_finite if inside is None else inside & is_finite
    usable = usable_vertices(surface.mesh)
    if not usable.all():
        inside = usable if inside is None else inside & usable
    return cut_to_mask(surface, inside)
