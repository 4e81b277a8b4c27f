"""Everything that open3d reads and this package does not: glTF, point clouds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats, Integers

MESH_SUFFIXES = {".glb", ".gltf", ".fbx", ".3ds", ".dae"}
POINT_SUFFIXES = {".xyz", ".xyzn", ".xyzrgb", ".pcd", ".pts"}


def import_open3d() -> Any:
    """The module open3d.

    Raises
    ------
    ValueError
        If it cannot be imported, with what to install.
    """
    try:
        import open3d
    except ImportError as error:
        raise ValueError(f"open3d is needed: {missing_part(error)} ({error})") from error
    return open3d


def missing_part(error: ImportError) -> str:
    """What to install after an import of open3d failed."""
    if isinstance(error, ModuleNotFoundError):
        return "pip install 'surfexp[open3d]'"
    if "libusb" in str(error):
        return "install the system package libusb-1.0-0 (apt-get install libusb-1.0-0)"
    return "install the system packages libusb-1.0-0, libgl1 and libgomp1"


def read_with_open3d(path: Path) -> tuple[Floats, Integers]:
    """Vertices and faces of a file in one of open3d's mesh formats.

    Raises
    ------
    ValueError
        If open3d is missing or the file is not readable.
    """
    open3d = import_open3d()
    with open3d.utility.VerbosityContextManager(open3d.utility.VerbosityLevel.Error):
        mesh = open3d.io.read_triangle_mesh(str(path))
    vertices, faces = np.array(mesh.vertices, dtype=np.float64), np.array(mesh.triangles, dtype=np.int64)
    if not len(faces):
        raise ValueError("open3d finds no triangle in it")
    return vertices, faces
