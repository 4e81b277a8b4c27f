"""Shapes as the TOSCA collection keeps them: pairs of .vert and .tri tables, or one .mat."""

from __future__ import annotations

import difflib
from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.numbers import index_array

TABLES = (".vert", ".tri")


def read_vert_tri(path: Path) -> tuple[Floats, Integers]:
    """Vertices and faces of two text tables of three columns; `path` names either. Faces count from 1.

    Raises
    ------
    ValueError
        If one of the files is missing or is not such a table.
    """
    tables = []
    for suffix in TABLES:
        part = path.with_suffix(suffix)
        if not part.is_file():
            raise ValueError(f"the file {part.name} beside it is missing")
        rows = [line.split() for line in part.read_text("ascii", "replace").splitlines() if line.strip()]
        if not rows or any(len(row) != 3 for row in rows):
            raise ValueError(f"{part.name} is empty or has a row without three columns")
        tables.append(np.array(rows, dtype=np.float64))
    return tables[0], index_array(tables[1], "the table of faces") - 1


def read_mat(path: Path) -> tuple[Floats, Integers]:
    """Vertices and faces of the variable `surface` of a MATLAB file, with X, Y, Z and TRIV, which counts from 1.

    Raises
    ------
    ValueError
        If the file has no such variable.
    """
    from scipy.io import loadmat

    content = loadmat(str(path), squeeze_me=True)
    if "surface" not in content:
        raise ValueError(f"{path.name} has no variable 'surface' with X, Y, Z and TRIV, as the files of TOSCA have")
    surface = content["surface"]
    points = np.stack([np.asarray(surface[axis].item(), dtype=np.float64) for axis in "XYZ"], axis=1)
    return points, np.asarray(surface["TRIV"].item(), dtype=np.int64) - 1


def shape_files(path: Path, shape: str = "") -> tuple[Path, Path | None]:
    """Return the file of a shape and its table of faces, None where one file holds all.

    Parameters
    ----------
    path : Path
        A file, or a folder that holds `shape`.
    shape : str
        Name without ending; needed in a folder.

    Raises
    ------
    ValueError
        If the folder has no such shape, or the file is that of another one.
    """
    if path.is_dir():
        shapes = {file.stem: file for file in sorted(path.iterdir()) if file.is_file() and file.suffix != ".tri"}
        if shape not in shapes:
            near = difflib.get_close_matches(shape, shapes, n=1, cutoff=0.0) if shape else sorted(shapes)[:3]
            hint = f"choose for example {', '.join(near)}" if near else "it holds no file"
            raise ValueError(f"folder {path.name} has no shape {shape!r}; {hint}")
        path = shapes[shape]
    elif shape and path.stem != shape:
        raise ValueError(f"{path.name} is not the shape {shape!r}; give its folder, or no shape")
    points, faces = (path.with_suffix(suffix) for suffix in TABLES)
    return (points, faces) if path.suffix in TABLES and points.is_file() and faces.is_file() else (path, None)
