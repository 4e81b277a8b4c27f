"""Writing of meshes: the format follows from the file's name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from surfexp.contract.arrays import Floats
from surfexp.io.freesurfer import hemisphere_of, write_freesurfer_geometry
from surfexp.io.gifti import write_gifti
from surfexp.io.hemisphere import check_named_side
from surfexp.io.map_names import check_map_names
from surfexp.io.obj import write_obj
from surfexp.io.off import write_off
from surfexp.io.ply import write_ply
from surfexp.io.replacing import check_writable, replacing
from surfexp.io.single_precision import check_single_precision_points
from surfexp.io.stl import write_stl
from surfexp.io.surface_archive import write_surface_archive
from surfexp.io.vtk import write_vtk
from surfexp.io.vtp import write_vtp
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.surface_facts import SurfaceFacts
from surfexp.mesh.triangle_mesh import TriangleMesh

Writer = Callable[[Path, TriangleMesh], None]
WriterOfMaps = Callable[[Path, TriangleMesh, dict[str, Floats]], None]
VTK: dict[str, WriterOfMaps] = {".vtk": write_vtk, ".vtp": write_vtp}
PLY, ARCHIVE = ".ply", ".npz"
WITH_MAPS = (PLY, *VTK, ARCHIVE)
WITHOUT_MAPS: dict[str, Writer] = {".off": write_off, ".obj": write_obj, ".stl": write_stl}
GIFTI = ".gii"
SUFFIXES = (*WITHOUT_MAPS, GIFTI, *WITH_MAPS)
SINGLE_PRECISION = (GIFTI, ".stl")
FREESURFER = (".pial", ".white", ".inflated", ".sphere", ".orig", ".midthickness")


def write_mesh(
    path: Path | str,
    mesh: TriangleMesh,
    scalars: dict[str, Floats] | None = None,
    frame: SpatialFrame | None = None,
    hemisphere: str = "",
    facts: SurfaceFacts | None = None,
) -> None:
    """Write a mesh as .off, .obj, .stl, .ply, .gii, .vtk, .vtp, .npz or FreeSurfer geometry.

    .ply, .vtk, .vtp and .npz carry scalar maps; .gii, .stl and FreeSurfer's files keep single precision. GIFTI and
    FreeSurfer's files carry their own part of `frame`, the space of the vertices; GIFTI and .ply the hemisphere. .npz
    carries all of these, and `facts`.

    Raises
    ------
    ValueError
        If the format is unknown or cannot carry scalar maps, a map has another length than the mesh, single precision
        cannot hold the mesh, or the file is named as the other hemisphere.
    """
    path, maps = Path(path), {}
    check_map_names(scalars or {})
    for name, values in (scalars or {}).items():
        if len(values) != len(mesh.vertices):
            raise ValueError(
                f"scalar map {name!r} has {len(values)} values, the mesh has {len(mesh.vertices)} vertices"
            )
        maps[name] = values
    writer = _writer(path, mesh, maps, frame, hemisphere, facts)
    with replacing(path) as temporary:
        writer(temporary)


def check_mesh_target(path: Path | str) -> None:
    """Refuse a file that no mesh can be written to: of an unknown format, or in no writable folder.

    Raises
    ------
    ValueError
        Naming the formats.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES and not _is_freesurfer(path):
        known = ", ".join([*SUFFIXES, *FREESURFER])
        raise ValueError(f"{path} has an unknown format, choose one of {known}")
    check_writable(path)


def _is_freesurfer(path: Path) -> bool:
    suffix = path.suffix.lower()
    return suffix in FREESURFER or (bool(hemisphere_of(path)) and suffix not in SUFFIXES)


def _writer(
    path: Path,
    mesh: TriangleMesh,
    maps: dict[str, Floats],
    frame: SpatialFrame | None,
    hemisphere: str,
    facts: SurfaceFacts | None,
) -> Callable[[Path], None]:
    """Return what writes the mesh, once the format is known to hold it."""
    check_mesh_target(path)
    check_named_side(path, hemisphere)
    suffix = path.suffix.lower()
    if suffix == ARCHIVE:
        return lambda place: write_surface_archive(place, mesh, maps, hemisphere, frame, facts)
    if suffix == PLY:
        return lambda place: write_ply(place, mesh, maps, hemisphere)
    if suffix in VTK:
        return lambda place: VTK[suffix](place, mesh, maps)
    if maps:
        raise ValueError(f"{path} cannot carry scalar maps ({', '.join(maps)}), choose one of {', '.join(WITH_MAPS)}")
    freesurfer = _is_freesurfer(path)
    if freesurfer or suffix in SINGLE_PRECISION:
        check_single_precision_points(mesh.vertices, mesh.faces)
        if freesurfer:
            return lambda place: write_freesurfer_geometry(place, mesh, frame.volume if frame is not None else None)
        if suffix == GIFTI:
            return lambda place: write_gifti(place, mesh, hemisphere, frame)
    return lambda place: WITHOUT_MAPS[suffix](place, mesh)


def format_of(path: Path) -> str:
    """Return "FreeSurfer", "GIFTI", or the suffix of the format in which a mesh is written."""
    if _is_freesurfer(path):
        return "FreeSurfer"
    return "GIFTI" if path.suffix.lower() == GIFTI else path.suffix.lower()
