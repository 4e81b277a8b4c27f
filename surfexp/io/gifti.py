"""GIFTI files (.gii, .gii.gz): geometry, maps and labels, decoded by nibabel."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.foreign import parsing
from surfexp.io.gifti_sizes import POINTS, TRIANGLES, check_gifti
from surfexp.io.numbers import index_array, real_array
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.spatial_frame import CoordinateTransform, SpatialFrame
from surfexp.mesh.triangle_mesh import TriangleMesh

LABELS = "NIFTI_INTENT_LABEL"
NODES = "NIFTI_INTENT_NODE_INDEX"
LARGEST_COUNT = 1 << 26
STRUCTURE = "AnatomicalStructurePrimary"
CORTEX = {"left": "CortexLeft", "right": "CortexRight"}


def is_gifti(path: Path) -> bool:
    """Whether the name is that of a GIFTI file."""
    return path.name.lower().endswith((".gii", ".gii.gz"))


def load_gifti(path: Path) -> Any:
    """Return nibabel's image of a file, whose sizes and external files were checked before.

    Raises
    ------
    ValueError
        As `check_gifti`, or if the file is not GIFTI or holds no array.
    """
    import nibabel

    check_gifti(path)
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
    return [np.asarray(array.data) for array in load_gifti(path).darrays]


def read_gifti_surface(path: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    """Points and triangles.

    Raises
    ------
    ValueError
        If the file holds no surface.
    """
    image = load_gifti(path)
    points, triangles = (image.get_arrays_from_intent(intent) for intent in (POINTS, TRIANGLES))
    if not points or not triangles:
        raise ValueError("GIFTI file holds no surface; if it is a map, give it as an image")
    return np.asarray(points[0].data), np.asarray(triangles[0].data)


def read_gifti_rest(path: Path) -> tuple[dict[str, Floats], SpatialFrame]:
    """The maps that stand beside a surface in its file, and where its points lie.

    Raises
    ------
    ValueError
        If an array is no map, or the file holds no surface.
    """
    image = load_gifti(path)
    surface = {image_code(POINTS), image_code(TRIANGLES)}
    beside = [array for array in image.darrays if array.intent not in surface and array.intent != image_code(LABELS)]
    points = next(array for array in image.darrays if array.intent == image_code(POINTS))
    system = points.coordsys
    transforms = []
    if system is not None:
        matrix = np.asarray(system.xform, dtype=np.float64).reshape(4, 4)
        transforms = [CoordinateTransform(_space(system.dataspace), _space(system.xformspace), matrix)]
    metadata = {str(key): str(value) for key, value in points.metadata.items()}
    return _maps(beside), SpatialFrame(transforms=tuple(transforms), metadata=metadata)


def _space(code: int) -> str:
    from nibabel.nifti1 import xform_codes

    return str(xform_codes.niistring[code])


def hemisphere_of_gifti(path: Path) -> str:
    """Return "left" or "right" where a GIFTI file of any content says so, else nothing.

    Raises
    ------
    ValueError
        If the file is not GIFTI.
    """
    image = load_gifti(path)
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
    image = load_gifti(path)
    return _maps(image.darrays)


def _maps(arrays: Sequence[Any]) -> dict[str, Floats]:
    maps: dict[str, Floats] = {}
    arrays, nodes = _nodes(arrays)
    for number, array in enumerate(arrays, 1):
        values = np.asarray(array.data)
        if values.ndim > 2 or array.intent == image_code(POINTS) or array.intent == image_code(TRIANGLES):
            raise ValueError(f"array {number} of the GIFTI file is no map but has shape {values.shape}")
        name = str(array.metadata.get("Name", "")).strip() or f"map {number}"
        maps[name if name not in maps else f"{name} {number}"] = _at_nodes(
            real_array(np.squeeze(values), "the map"), nodes
        )
    return maps


def _nodes(arrays: Sequence[Any]) -> tuple[list[Any], Integers | None]:
    """Return the arrays that hold values, and the vertex of each row where the file lists them.

    Raises
    ------
    ValueError
        If vertices are listed twice.
    """
    lists = [array for array in arrays if array.intent == image_code(NODES)]
    if len(lists) > 1:
        raise ValueError(f"it has {len(lists)} arrays of {NODES}, one is read")
    values = [array for array in arrays if array.intent != image_code(NODES)]
    return values, index_array(np.ravel(lists[0].data), "its node indices") if lists else None


def _at_nodes(values: NDArray[Any], nodes: Integers | None, missing: float = np.nan) -> NDArray[Any]:
    """Put rows at the vertices that the file lists for them; the vertices between are missing."""
    if nodes is None:
        return values
    if len(values) != len(nodes) or len(np.unique(nodes)) < len(nodes) or nodes.min() < 0:
        raise ValueError(
            f"it lists {len(nodes)} node indices, not one vertex of its own for each of {len(values)} values"
        )
    if nodes.max() >= LARGEST_COUNT:
        raise ValueError(f"it lists node {nodes.max()}, the largest is {LARGEST_COUNT - 1}")
    whole = np.full((int(nodes.max()) + 1, *values.shape[1:]), missing, dtype=values.dtype)
    whole[nodes] = values
    return whole


def read_gifti_labels(path: Path) -> LabelMap:
    """The labels of a .label.gii, with the names of its table.

    Raises
    ------
    ValueError
        If the file is not GIFTI.
    """
    image = load_gifti(path)
    # an empty name is no attribute of nibabel's entry
    names = {int(entry.key): str(getattr(entry, "label", "")) for entry in image.labeltable.labels}
    arrays, nodes = _nodes(image.darrays)
    if not arrays:
        raise ValueError("it holds no labels")
    # an array of another kind, such as a map, may stand before the labels
    first = next((array for array in arrays if array.intent == image_code(LABELS)), arrays[0])
    return LabelMap(_at_nodes(index_array(first.data, "its labels"), nodes, -1), names)


def image_code(intent: str) -> int:
    """Number of an intent in GIFTI."""
    from nibabel.nifti1 import intent_codes

    return int(intent_codes[intent])


def write_gifti(path: Path, mesh: TriangleMesh, hemisphere: str, frame: SpatialFrame | None) -> None:
    """Write points (float32, as the format has them) with their space, and triangles, compressed inside the XML."""
    import nibabel

    gifti = nibabel.gifti
    said = dict(frame.metadata) if frame is not None else {}
    meta = gifti.GiftiMetaData(said | _structure(hemisphere))
    # nibabel holds one transform of each array
    transform = frame.transforms[0] if frame is not None and frame.transforms else None
    system = None
    if transform is not None:
        codes = (nibabel.nifti1.xform_codes[name] for name in (transform.source, transform.target))
        system = gifti.GiftiCoordSystem(*codes, transform.matrix)
    points = gifti.GiftiDataArray(mesh.vertices.astype(np.float32), POINTS, coordsys=system, meta=meta)
    triangles = gifti.GiftiDataArray(mesh.faces.astype(np.int32), TRIANGLES)
    nibabel.save(gifti.GiftiImage(darrays=[points, triangles]), path)


def write_gifti_maps(path: Path, maps: dict[str, Floats], hemisphere: str) -> None:
    """Write maps as one array each, single precision, NaN included."""
    import nibabel

    gifti = nibabel.gifti
    meta = gifti.GiftiMetaData(_structure(hemisphere))
    intent = "NIFTI_INTENT_SHAPE" if path.name.endswith(".shape.gii") else "NIFTI_INTENT_NONE"
    arrays = [
        gifti.GiftiDataArray(
            np.asarray(values, dtype=np.float32), intent, "NIFTI_TYPE_FLOAT32", meta=gifti.GiftiMetaData({"Name": name})
        )
        for name, values in maps.items()
    ]
    nibabel.save(gifti.GiftiImage(darrays=arrays, meta=meta), path)


def write_gifti_labels(
    path: Path, keys: Integers, names: dict[int, str], colors: NDArray[np.int64], hemisphere: str
) -> None:
    """Write labels with their names and a colour for each, 0 to 255."""
    import nibabel

    gifti = nibabel.gifti
    table = gifti.GiftiLabelTable()
    for (key, name), color in zip(names.items(), colors / 255.0, strict=True):
        entry = gifti.GiftiLabel(key, *map(float, color), 1.0)
        entry.label = name
        table.labels.append(entry)
    array = gifti.GiftiDataArray(keys.astype(np.int32), LABELS, datatype="NIFTI_TYPE_INT32")
    meta = gifti.GiftiMetaData(_structure(hemisphere))
    nibabel.save(gifti.GiftiImage(labeltable=table, darrays=[array], meta=meta), path)


def _structure(hemisphere: str) -> dict[str, str]:
    """The metadata that name a hemisphere; none for what is no hemisphere."""
    return {STRUCTURE: CORTEX[hemisphere]} if hemisphere in CORTEX else {}
