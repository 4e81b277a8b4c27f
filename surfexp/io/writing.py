"""Writing of meshes: the format follows from the file's name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from surfexp.contract.arrays import Floats
from surfexp.io.freesurfer import hemisphere_of, write_freesurfer_geometry
from surfexp.io.gifti import write_gifti
from surfexp.io.npz import write_npz_mesh
from surfexp.io.obj import write_obj
from surfexp.io.off import write_off
from surfexp.io.ply import write_ply
from surfexp.io.single_precision import check_single_precision_points
from surfexp.io.stl import write_stl
from surfexp.io.vtk import write_vtk
from surfexp.io.vtp import write_vtp
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.triangle_mesh import TriangleMesh

Writer = Callable[[Path, TriangleMesh], None]
WriterOfMaps = Callable[[Path, TriangleMesh, dict[str, Floats]], None]
WITH_MAPS: dict[str, WriterOfMaps] = {".ply": write_ply, ".vtk": write_vtk, ".vtp": write_vtp, ".npz": write_npz_mesh}
WITHOUT_MAPS: dict[str, Writer] = {".off": write_off, ".obj": write_obj, ".gii": write_gifti, ".stl": write_stl}
SINGLE_PRECISION = (".gii", ".stl")
FREESURFER = (".pial", ".white", ".inflated", ".sphere", ".orig", ".midthickness")


def write_mesh(
    path: Path | str, mesh: TriangleMesh, scalars: dict[str, Floats] | None = None, frame: SpatialFrame | None = None
) -> None:
    """Write a mesh as .off, .obj, .stl, .ply, .gii, .vtk, .vtp, .npz or FreeSurfer geometry.

    .ply, .vtk, .vtp and .npz carry scalar maps; .gii, .stl and FreeSurfer's files keep single precision. GIFTI and
    FreeSurfer's files carry their own part of `frame`, the space of the vertices.

    Raises
    ------
    ValueError
        If the format is unknown or cannot carry scalar maps, a map has another length than the mesh, or single precision
        cannot hold the mesh.
    """
    path, maps = Path(path), scalars or {}
    for name, values in maps.items():
        if len(values) != len(mesh.vertices):
            raise ValueError(
                f"scalar map {name!r} has {len(values)} values, the mesh has {len(mesh.vertices)} vertices"
            )
    suffix = path.suffix.lower()
    freesurfer = format_of(path) == "FreeSurfer"
    if suffix in WITH_MAPS:
        WITH_MAPS[suffix](path, mesh, maps)
    elif not freesurfer and suffix not in WITHOUT_MAPS:
        known = ", ".join([*WITHOUT_MAPS, *WITH_MAPS, *FREESURFER])
        raise ValueError(f"{path} has an unknown format, choose one of {known}")
    elif maps:
        raise ValueError(f"{path} cannot carry scalar maps ({', '.join(maps)}), choose one of {', '.join(WITH_MAPS)}")
    elif freesurfer or suffix in SINGLE_PRECISION:
        check_single_precision_points(mesh.vertices, mesh.faces)
        if freesurfer:
            write_freesurfer_geometry(path, mesh, frame.volume if frame is not None else None)
        elif suffix == ".gii":
            write_gifti(path, mesh, frame=frame)
        else:
            WITHOUT_MAPS[suffix](path, mesh)
    else:
        WITHOUT_MAPS[suffix](path, mesh)


def format_of(path: Path) -> str:
    """Return "FreeSurfer", "GIFTI", or the suffix of the format in which a mesh is written."""
    suffix = path.suffix.lower()
    if suffix in FREESURFER or (hemisphere_of(path) and suffix not in (*WITH_MAPS, *WITHOUT_MAPS)):
        return "FreeSurfer"
    return "GIFTI" if suffix == ".gii" else suffix
