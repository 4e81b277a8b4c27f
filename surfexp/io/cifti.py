"""CIFTI-2 files (.dscalar.nii, .dlabel.nii, .dtseries.nii): maps of cortex by hemisphere, decoded by nibabel."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.io.foreign import parsing
from surfexp.io.map_names import told_apart
from surfexp.io.numbers import real_array
from surfexp.mesh.label_map import LabelMap

SUFFIXES = (".dscalar.nii", ".dlabel.nii", ".dtseries.nii", ".pscalar.nii")
STRUCTURES = {"left": "CIFTI_STRUCTURE_CORTEX_LEFT", "right": "CIFTI_STRUCTURE_CORTEX_RIGHT"}


def is_cifti(path: Path) -> bool:
    """Whether the name is that of a CIFTI-2 file."""
    return path.name.lower().endswith(SUFFIXES)


def read_cifti_maps(path: Path, hemisphere: str) -> dict[str, Floats]:
    """Return the maps of one hemisphere by name; vertices that the file leaves out, the medial wall, are NaN.

    A time series is one map (n, frames) named "series".

    Raises
    ------
    ValueError
        If the file is no CIFTI-2 file or has no vertices of that hemisphere.
    """
    axis, values = _rows(path, hemisphere)
    kind = type(axis).__name__
    if kind == "SeriesAxis":
        return {"series": np.ascontiguousarray(values.T)}
    return {name: np.ascontiguousarray(row) for name, row in zip(told_apart(axis.name), values, strict=True)}


def read_cifti_labels(path: Path, hemisphere: str) -> dict[str, LabelMap]:
    """Return the label maps of one hemisphere of a .dlabel.nii by name; vertices that it leaves out have the label -1.

    Raises
    ------
    ValueError
        If the file is no .dlabel.nii or has no vertices of that hemisphere.
    """
    axis, values = _rows(path, hemisphere)
    if type(axis).__name__ != "LabelAxis":
        raise ValueError(f"it holds maps of type {type(axis).__name__}, labels are needed (.dlabel.nii)")
    rows = np.where(np.isnan(values), -1.0, values).astype(np.int64)
    tables = ({int(key): str(name) for key, (name, _) in table.items()} for table in axis.label)
    return {name: LabelMap(row, table) for name, row, table in zip(told_apart(axis.name), rows, tables, strict=True)}


def hemisphere_of_cifti(path: Path) -> str:
    """Return the hemisphere of which a file has vertices, nothing where it has those of both or of none.

    Raises
    ------
    ValueError
        If the file is no CIFTI-2 file.
    """
    import nibabel

    with parsing("CIFTI-2 file"):
        models = nibabel.cifti2.load(path).header.get_axis(1)
        names = {str(name) for name in models.name} if type(models).__name__ == "BrainModelAxis" else set()
    sides = [side for side, structure in STRUCTURES.items() if structure in names]
    return sides[0] if len(sides) == 1 else ""


def write_cifti_maps(path: Path, maps: dict[str, Floats], hemisphere: str | NDArray[np.str_]) -> None:
    """Write maps of one hemisphere as .dscalar.nii in single precision; vertices that are NaN in all maps are left out.

    Of both hemispheres `hemisphere` says that of each vertex.

    Raises
    ------
    ValueError
        If the hemisphere is not said or the maps are finite nowhere.
    """
    from nibabel import cifti2

    values = np.stack(list(maps.values())).astype(np.float32)
    inside: NDArray[np.bool_] = np.asarray(np.isfinite(values).any(axis=0))
    if not inside.any():
        raise ValueError("no map has a finite value")
    words = [hemisphere] if isinstance(hemisphere, str) else list(STRUCTURES)
    # a side where nothing is known has no model
    sides = [side for side in words if inside[np.broadcast_to(np.asarray(hemisphere) == side, len(inside))].any()]
    rows = [np.flatnonzero(np.broadcast_to(np.asarray(hemisphere) == side, len(inside))) for side in sides]
    models = [
        cifti2.BrainModelAxis.from_mask(inside[own], name=_structure(side))
        for side, own in zip(sides, rows, strict=True)
    ]
    header = cifti2.Cifti2Header.from_axes((cifti2.ScalarAxis(list(maps)), sum(models[1:], models[0])))
    columns = np.concatenate([own[inside[own]] for own in rows])
    cifti2.Cifti2Image(values[:, columns], header).to_filename(path)


def _rows(path: Path, hemisphere: str) -> tuple[Any, Floats]:
    """Return the first axis, and (maps, n) values of one hemisphere with NaN where the file has none."""
    import nibabel

    structure = _structure(hemisphere)
    with parsing("CIFTI-2 file"):
        image = nibabel.cifti2.load(path)
        first, models = (image.header.get_axis(k) for k in range(2))
        stored = np.asarray(image.dataobj)
    data = real_array(stored, "its data")
    if type(models).__name__ != "BrainModelAxis":
        raise ValueError(
            f"its columns are a {type(models).__name__}, vertices of cortex are needed: write a dense map (.dscalar.nii)"
        )
    for name, columns, model in models.iter_structures():
        if name == structure:
            count = int(models.nvertices[name])
            whole = np.full((len(data), count), np.nan)
            whole[:, model.vertex] = data[:, columns]
            return first, whole
    known = ", ".join(sorted({str(name) for name in models.name}))
    raise ValueError(f"it has no vertices of {structure}; it has {known}")


def _structure(hemisphere: str) -> str:
    if hemisphere not in STRUCTURES:
        raise ValueError(f"hemisphere is {hemisphere!r}: a CIFTI file needs left or right (from the surface, or given)")
    return STRUCTURES[hemisphere]
