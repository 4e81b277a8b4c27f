"""numpy's archives (.npz) and arrays (.npy): named arrays, never pickled objects."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.foreign import parsing
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.numbers import checked_geometry, real_array
from surfexp.io.unpacked_sizes import check_arrays
from surfexp.mesh.triangle_mesh import TriangleMesh


def read_arrays(path: Path) -> dict[str, NDArray[np.generic]]:
    """Return the arrays of an archive by name, or the one array of a .npy under the name "map".

    Raises
    ------
    ValueError
        If the file is broken or holds objects.
    """
    check_arrays(path)
    with parsing("array file"):
        loaded = np.load(path, allow_pickle=False)
    if isinstance(loaded, np.ndarray):
        return {"map": loaded}
    if path.suffix == ".npy":
        raise ValueError("it is an archive of several arrays: name it .npz")
    with parsing("array file"), loaded:
        return {name: loaded[name] for name in loaded.files}


def read_npz_mesh(path: Path) -> tuple[Floats, Integers, dict[str, Floats]]:
    """Return `vertices`, `faces`, and every other array with one row a vertex as a map.

    Raises
    ------
    ValueError
        If the two are not there.
    """
    arrays = read_arrays(path)
    if not {"vertices", "faces"} <= set(arrays):
        raise ValueError(f"it has the arrays {', '.join(arrays) or 'none'}; 'vertices' and 'faces' are needed")
    vertices, faces = arrays.pop("vertices"), arrays.pop("faces")
    maps = {name: real_array(values, name) for name, values in arrays.items() if values.shape[:1] == vertices.shape[:1]}
    return *checked_geometry(vertices, faces), maps


def write_npz_mesh(path: Path, mesh: TriangleMesh, maps: dict[str, Floats]) -> None:
    """Write vertices, faces and maps, compressed.

    Raises
    ------
    ValueError
        If a map is called "vertices" or "faces".
    """
    if {"vertices", "faces"} & set(maps):
        raise ValueError("a map is called 'vertices' or 'faces', the names of the mesh: rename it")
    arrays: dict[str, Any] = {"vertices": mesh.vertices, "faces": mesh.faces, **scalar_channels(maps)}
    np.savez_compressed(path, **arrays)
