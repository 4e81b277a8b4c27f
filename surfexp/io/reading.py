"""Reading of surfaces: the format follows from the file's name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.io import freesurfer
from surfexp.io.declared_sizes import check_declared_sizes
from surfexp.io.entrance import reading
from surfexp.io.gifti import is_gifti, read_gifti_rest, read_gifti_surface
from surfexp.io.map_files import read_maps
from surfexp.io.map_shapes import check_map_shapes
from surfexp.io.mesh_file import Decoded, MeshFile
from surfexp.io.numbers import LARGEST_BYTES, checked_geometry, real_array
from surfexp.io.obj import read_obj
from surfexp.io.off import read_off
from surfexp.io.open3d_files import MESH_SUFFIXES, POINT_SUFFIXES, read_with_open3d
from surfexp.io.ply import read_ply
from surfexp.io.polygons import triangulate
from surfexp.io.space_notes import space_notes
from surfexp.io.stl import read_stl
from surfexp.io.surface_archive import read_surface_archive
from surfexp.io.tosca import read_vert_tri
from surfexp.io.vtk import read_vtk
from surfexp.io.vtp import read_vtp, read_vtu
from surfexp.mesh.spatial_frame import SpatialFrame

READERS: dict[str, Callable[[Path], Decoded]] = {".off": read_off, ".obj": read_obj, ".stl": read_stl, ".ply": read_ply}
READERS |= {".vtk": read_vtk, ".vtp": read_vtp, ".vtu": read_vtu, ".npz": read_surface_archive}
ARRAYS: dict[str, Callable[[Path], Any]] = {".vert": read_vert_tri, ".tri": read_vert_tri}
ARRAYS |= {".asc": freesurfer.read_ascii_geometry}
KNOWN = ", ".join([*READERS, ".gii, .vert/.tri, .asc, FreeSurfer geometry, and with open3d .glb, .gltf, .fbx"])

__all__ = ["read_maps", "read_mesh", "read_mesh_file"]


def read_mesh(path: Path | str) -> tuple[Floats, Integers, dict[str, Floats]]:
    """Vertices, faces and scalar maps of a mesh file, exactly as they stand there.

    Raises
    ------
    ValueError
        As `read_mesh_file`.
    """
    file = read_mesh_file(path)
    return file.vertices, file.faces, file.scalars


def read_mesh_file(path: Path | str) -> MeshFile:
    """Return all that a mesh file holds, exactly as it stands there, with what was passed over.

    OFF, OBJ (also MNI's), PLY, STL (welded), VTK (.vtk, .vtp, .vtu), GIFTI, npz, FreeSurfer geometry (any name), TOSCA's
    .vert/.tri; what open3d reads beside. Polygons become triangles. Numbers are checked, the surface is not: see
    `surfexp.mesh.validate`.

    Raises
    ------
    ValueError
        If the file is missing, of an unknown format, broken or cut off, or holds points alone; the message begins with its name.
    """
    path = Path(path)
    with reading(path, "cannot be read as a mesh"):
        found = _read(path)
        vertices = real_array(np.asarray(found.vertices), "the vertices")
        faces, notes = triangulate(found.polygons, vertices)
        points, corners = checked_geometry(vertices, faces)
        if len(points) and not len(corners):
            raise ValueError(
                f"it holds {len(points)} points without faces: make a surface of them first (surfexp info surface/point_cloud)"
            )
        check_map_shapes(found.scalars)
        for name, values in found.scalars.items():
            if len(values) != len(points):
                raise ValueError(f"map {name!r} has {len(values)} values for {len(points)} vertices")
    return MeshFile(
        points, corners, found.scalars, (*found.notes, *notes, *space_notes(path)), found.frame, found.facts
    )


def _read(path: Path) -> Decoded:
    suffix = path.suffix.lower()
    if not path.is_file():
        raise ValueError(f"no such file in {path.parent.absolute()}")
    size = path.stat().st_size
    if not 0 < size <= LARGEST_BYTES:
        raise ValueError("the file is empty" if size == 0 else f"it has {size} bytes, the most is {LARGEST_BYTES}")
    if suffix in READERS:
        return READERS[suffix](path)
    if suffix in ARRAYS:
        return Decoded(*ARRAYS[suffix](path))
    if is_gifti(path):
        check_declared_sizes(path)
        points, triangles = read_gifti_surface(path)
        maps, frame = read_gifti_rest(path)
        return Decoded(points, triangles, maps, frame=frame)
    if suffix in MESH_SUFFIXES:
        return Decoded(*read_with_open3d(path))
    if suffix in POINT_SUFFIXES:
        raise ValueError(
            f"{suffix} holds points without faces; make a surface of them first (surfexp info surface/point_cloud)"
        )
    if freesurfer.is_geometry(path):
        _check_no_map(path, size)
        vertices, faces = freesurfer.read_geometry(path)
        return Decoded(vertices, faces, frame=SpatialFrame(volume=freesurfer.read_volume_geometry(path)))
    raise ValueError(f"its format is unknown; known are {KNOWN}")


def _check_no_map(path: Path, size: int) -> None:
    """Refuse FreeSurfer's maps, which begin as quadrangles do and say how many vertices they have."""
    with path.open("rb") as stream:
        head = stream.read(7)
    count = int.from_bytes(head[3:], "big")
    if head[:3] == b"\xff\xff\xff" and size == 15 + 4 * count:
        raise ValueError(f"it is a map of FreeSurfer's for {count} vertices: give the surface first, then the map")
