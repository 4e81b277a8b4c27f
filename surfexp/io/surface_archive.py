"""Surfaces in numpy's archives (.npz), the format that holds all that is read of a surface.

`vertices`, `faces` and the maps stand under their own names, so that `numpy.load` is enough to use them. Mask, labels, unit
and frame have names that begin with "surface."; the hemisphere is a word, or one word a vertex.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.mesh_file import Decoded
from surfexp.io.npz import HEMISPHERE, MESH, OWN, SIDES, read_arrays, write_arrays
from surfexp.io.numbers import checked_geometry, real_array
from surfexp.io.surface_record import SurfaceRecord, written_record
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.surface_facts import SurfaceFacts
from surfexp.mesh.triangle_mesh import TriangleMesh

MASK, LABELS, RECORD = f"{OWN}mask", f"{OWN}labels.", f"{OWN}record"


def read_surface_archive(path: Path) -> Decoded:
    """Return `vertices`, `faces`, every other array with one row a vertex as a map, and the facts beside them.

    Raises
    ------
    ValueError
        If the first two are not there, or the facts do not fit them.
    """
    arrays = read_arrays(path)
    if not set(MESH) <= set(arrays):
        raise ValueError(f"it has the arrays {', '.join(arrays) or 'none'}; 'vertices' and 'faces' are needed")
    vertices, faces = checked_geometry(*(arrays.pop(name) for name in MESH))
    own = {name: arrays.pop(name) for name in list(arrays) if name.startswith(OWN)}
    sides = _sides(arrays, len(vertices))
    maps = {name: real_array(values, name) for name, values in arrays.items() if values.shape[:1] == (len(vertices),)}
    frame, facts = _facts(own, len(vertices), sides)
    return Decoded(vertices, faces, maps, frame=frame, facts=facts)


def write_surface_archive(
    path: Path,
    mesh: TriangleMesh,
    maps: Mapping[str, Floats],
    hemisphere: str = "",
    frame: SpatialFrame | None = None,
    facts: SurfaceFacts | None = None,
) -> None:
    """Write all of a surface, compressed.

    Raises
    ------
    ValueError
        As `write_arrays`, or if a map has the name of another part.
    """
    reserved = next((name for name in maps if name in MESH or name.startswith(OWN)), None)
    if reserved is not None:
        raise ValueError(f"a map is called {reserved!r}, the name of another part of the archive: rename it")
    facts = facts or SurfaceFacts()
    arrays: dict[str, NDArray[Any]] = {"vertices": mesh.vertices, "faces": mesh.faces, **scalar_channels(dict(maps))}
    if facts.mask is not None:
        arrays[MASK] = facts.mask
    arrays |= {f"{LABELS}{name}": table.keys for name, table in facts.labels.items()}
    if record := written_record(frame or SpatialFrame(), facts):
        arrays[RECORD] = np.array(record)
    sides = hemisphere if facts.right is None else np.where(facts.right, "right", "left")
    write_arrays(path, arrays, sides)


def _sides(arrays: dict[str, NDArray[Any]], count: int) -> NDArray[np.bool_] | None:
    """Take the words that say the side of each vertex out of the arrays; return which are of the right one."""
    if HEMISPHERE not in arrays or arrays[HEMISPHERE].dtype.kind != "U":
        return None
    said = arrays.pop(HEMISPHERE)
    if not said.ndim:
        return None
    if said.shape != (count,) or not np.isin(said, SIDES).all():
        raise ValueError(
            f"{HEMISPHERE!r} has shape {said.shape}: 'left' or 'right' is needed for each of {count} vertices"
        )
    return np.asarray(said == "right")


def _facts(
    own: dict[str, NDArray[Any]], count: int, right: NDArray[np.bool_] | None
) -> tuple[SpatialFrame, SurfaceFacts]:
    for name, values in own.items():
        kinds, rows = ("U", ()) if name == RECORD else ("b", (count,)) if name == MASK else ("iu", (count,))
        if values.dtype.kind not in kinds or values.shape != rows:
            raise ValueError(f"array {name!r} has shape {values.shape} and type {values.dtype}, {rows} is needed")
    if RECORD not in own:
        return SpatialFrame(), SurfaceFacts(mask=own.get(MASK), right=right)
    record = SurfaceRecord(str(own[RECORD]))
    lost = next((name for name in record.label_names if f"{LABELS}{name}" not in own), None)
    if lost is not None:
        raise ValueError(f"its labels {lost!r} have names and no array {LABELS}{lost}")
    labels = {name: record.labels(name, own[f"{LABELS}{name}"].astype(np.int64)) for name in record.label_names}
    return record.frame, SurfaceFacts(record.unit, own.get(MASK), labels, right)
