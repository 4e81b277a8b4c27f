"""GIFTI files (.gii, .gii.gz): geometry, maps and labels, decoded by nibabel."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.foreign import parsing
from surfexp.io.numbers import real_array
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.triangle_mesh import TriangleMesh

POINTS, TRIANGLES, LABELS = "NIFTI_INTENT_POINTSET", "NIFTI_INTENT_TRIANGLE", "NIFTI_INTENT_LABEL"
STRUCTURE = "AnatomicalStructurePrimary"
CORTEX = {"left": "CortexLeft", "right": "CortexRight"}


def is_gifti(path: Path) -> bool:
    """Whether the name is that of a GIFTI file."""
    return path.name.lower().endswith((".gii", ".gii.gz"))


def _load(path: Path) -> Any:
    import nibabel

    with parsing("GIFTI file"):
        image = nibabel.load(path)
        arrays = [np.asarray(array.data) for array in image.darrays]
    if not arrays or any(array.size == 0 for array in arrays):
        raise ValueError("it is a GIFTI file without data arrays")
    return image


def read_gifti_arrays(path: Path) -> list[NDArray[Any]]:
    """All data arrays of a GIFTI file, in their order: points and triangles of a surface, values of a map.

    Raises
    ------
    ValueError
        If the file is not GIFTI, is cut off or holds no array.
    """
    return [np.asarray(array.data) for array in _load(path).darrays]


def read_gifti_surface(path: Path) -> tuple[NDArray[Any], NDArray[Any], str]:
    """Points, triangles, and "left" or "right" where the file says so.

    Raises
    ------
    ValueError
        If the file holds no surface.
    """
    image = _load(path)
    points, triangles = (image.get_arrays_from_intent(intent) for intent in (POINTS, TRIANGLES))
    if not points or not triangles:
        raise ValueError("GIFTI file holds no surface; if it is a map, give it as an image")
    said = str(points[0].metadata.get(STRUCTURE, image.meta.get(STRUCTURE, "")))
    return np.asarray(points[0].data), np.asarray(triangles[0].data), {v: k for k, v in CORTEX.items()}.get(said, "")


def hemisphere_of_gifti(path: Path) -> str:
    """Return "left" or "right" where a GIFTI file of any content says so, else nothing.

    Raises
    ------
    ValueError
        If the file is not GIFTI.
    """
    image = _load(path)
    said = {str(part.get(STRUCTURE, "")) for part in (image.meta, *(array.metadata for array in image.darrays))}
    sides = {side for side, word in CORTEX.items() if word in said}
    return sides.pop() if len(sides) == 1 else ""


def read_gifti_maps(path: Path) -> dict[str, Floats]:
    """The maps of a .shape.gii or .func.gii by name; without names they count from 1.

    Raises
    ------
    ValueError
        If the file is not GIFTI or holds a surface.
    """
    image = _load(path)
    maps: dict[str, Floats] = {}
    for number, array in enumerate(image.darrays, 1):
        values = np.asarray(array.data)
        if values.ndim > 2 or array.intent == image_code(POINTS) or array.intent == image_code(TRIANGLES):
            raise ValueError(f"array {number} of the GIFTI file is no map but has shape {values.shape}")
        name = str(array.metadata.get("Name", "")).strip() or f"map {number}"
        maps[name if name not in maps else f"{name} {number}"] = real_array(np.squeeze(values), "the map")
    return maps


def read_gifti_labels(path: Path) -> LabelMap:
    """The labels of a .label.gii, with the names of its table.

    Raises
    ------
    ValueError
        If the file is not GIFTI.
    """
    image = _load(path)
    names = {int(key): str(name) for key, name in image.labeltable.get_labels_as_dict().items()}
    return LabelMap(np.asarray(image.darrays[0].data, dtype=np.int64), names)


def image_code(intent: str) -> int:
    """Number of an intent in GIFTI."""
    from nibabel.nifti1 import intent_codes

    return int(intent_codes[intent])


def write_gifti(path: Path, mesh: TriangleMesh, hemisphere: str = "") -> None:
    """Write points (float32, as the format has them) and triangles, compressed inside the XML."""
    import nibabel

    gifti = nibabel.gifti
    meta = gifti.GiftiMetaData({STRUCTURE: CORTEX[hemisphere]} if hemisphere else {})
    points = gifti.GiftiDataArray(mesh.vertices.astype(np.float32), POINTS, meta=meta)
    triangles = gifti.GiftiDataArray(mesh.faces.astype(np.int32), TRIANGLES)
    nibabel.save(gifti.GiftiImage(darrays=[points, triangles]), path)


def write_gifti_maps(path: Path, maps: dict[str, Floats], hemisphere: str = "") -> None:
    """Write maps as one array each, single precision, NaN included."""
    import nibabel

    gifti = nibabel.gifti
    meta = gifti.GiftiMetaData({STRUCTURE: CORTEX[hemisphere]} if hemisphere else {})
    intent = "NIFTI_INTENT_SHAPE" if path.name.endswith(".shape.gii") else "NIFTI_INTENT_NONE"
    arrays = [
        gifti.GiftiDataArray(
            np.asarray(values, dtype=np.float32), intent, "NIFTI_TYPE_FLOAT32", meta=gifti.GiftiMetaData({"Name": name})
        )
        for name, values in maps.items()
    ]
    nibabel.save(gifti.GiftiImage(darrays=arrays, meta=meta), path)


def write_gifti_labels(path: Path, keys: Integers, names: dict[int, str], colors: NDArray[np.int64]) -> None:
    """Write labels with their names and a colour for each, 0 to 255."""
    import nibabel

    gifti = nibabel.gifti
    table = gifti.GiftiLabelTable()
    for (key, name), color in zip(names.items(), colors / 255.0, strict=True):
        entry = gifti.GiftiLabel(key, *map(float, color), 1.0)
        entry.label = name
        table.labels.append(entry)
    array = gifti.GiftiDataArray(keys.astype(np.int32), LABELS, datatype="NIFTI_TYPE_INT32")
    nibabel.save(gifti.GiftiImage(labeltable=table, darrays=[array]), path)
