"""Reading of meshes and scalar maps: the format follows from the file's name."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.arrays import Floats, Integers
from surfexp.io import freesurfer
from surfexp.io.gifti import read_gifti_arrays
from surfexp.io.obj import read_obj
from surfexp.io.off import read_off
from surfexp.io.open3d_files import MESH_SUFFIXES, POINT_SUFFIXES, read_with_open3d
from surfexp.io.ply import read_ply
from surfexp.io.stl import read_stl
from surfexp.io.tosca import read_vert_tri
from surfexp.mesh.npy import read_npy

SIMPLE = {".off": read_off, ".obj": read_obj, ".stl": read_stl, ".vert": read_vert_tri, ".tri": read_vert_tri}
KNOWN = ".off, .obj, .ply, .stl, .gii, .vert/.tri, FreeSurfer geometry, and with open3d .glb, .gltf, .fbx"


def read_mesh(path: Path | str) -> tuple[Floats, Integers, dict[str, Floats]]:
    """Vertices, faces and scalar maps of a mesh file, exactly as they stand there.

    OFF, OBJ, PLY, STL (welded), GIFTI, FreeSurfer geometry (any name), TOSCA's .vert/.tri; what open3d reads beside.
    Polygons become triangles. Nothing is checked but the format: see `surfexp.mesh.validate`.

    Raises
    ------
    ValueError
        If the file is missing, of an unknown format, broken or cut off; the message begins with the file's name.
    """
    path = Path(path)
    try:
        vertices, faces, scalars = _read(path)
    except (ValueError, OSError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise ValueError(f"{path} cannot be read as a mesh: {reason}") from error
    if len(faces) and not 0 <= faces.min() <= faces.max() < len(vertices):
        bad = faces.max() if faces.min() >= 0 else faces.min()
        raise ValueError(f"{path} cannot be used: a face names vertex {bad}, the vertices are 0..{len(vertices) - 1}")
    return vertices, faces, scalars


def _read(path: Path) -> tuple[Floats, Integers, dict[str, Floats]]:
    suffix = path.suffix.lower()
    if not path.is_file():
        raise ValueError(f"no such file in {path.parent.absolute()}")
    if path.stat().st_size == 0:
        raise ValueError("the file is empty")
    if suffix in SIMPLE:
        return *SIMPLE[suffix](path), {}
    if suffix == ".ply":
        return read_ply(path)
    if path.name.lower().endswith((".gii", ".gii.gz")):
        arrays = read_gifti_arrays(path)
        if len(arrays) < 2 or any(array.ndim != 2 or array.shape[1] != 3 for array in arrays[:2]):
            raise ValueError("GIFTI file holds no surface; if it is a map, give it as an image")
        return arrays[0].astype(np.float64), arrays[1].astype(np.int64), {}
    if suffix in MESH_SUFFIXES:
        return *read_with_open3d(path), {}
    if suffix in POINT_SUFFIXES:
        raise ValueError(f"{suffix} holds points without faces; reconstruct a surface from them first (point_cloud)")
    if freesurfer.is_geometry(path):
        return *freesurfer.read_geometry(path), {}
    raise ValueError(f"its format is unknown; known are {KNOWN}")


def read_scalars(path: Path | str) -> Floats:
    """(n,) or (n, c) values of a scalar map: .npy, .txt, .csv, GIFTI, else FreeSurfer curvature (lh.sulc).

    Raises
    ------
    ValueError
        If the file is missing, broken or cut off; the message begins with the file's name.
    """
    path = Path(path)
    try:
        if path.suffix == ".npy":
            return read_npy(path)
        if path.suffix in (".txt", ".csv", ".dat"):
            separator = "," if path.suffix == ".csv" else None
            return np.asarray(np.loadtxt(path, delimiter=separator, dtype=np.float64))
        if path.name.lower().endswith((".gii", ".gii.gz")):
            return np.squeeze(np.stack(read_gifti_arrays(path), axis=-1)).astype(np.float64)
        return freesurfer.read_map(path)
    except (ValueError, OSError, EOFError) as error:
        raise ValueError(f"{path} cannot be read as a scalar map: {str(error).splitlines()[0]}") from error
