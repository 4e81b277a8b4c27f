"""Writing of meshes: the format follows from the file's name."""

from __future__ import annotations

from pathlib import Path

from surfexp.arrays import Floats
from surfexp.io.gifti import write_gifti
from surfexp.io.obj import write_obj
from surfexp.io.off import write_off
from surfexp.io.ply import write_ply
from surfexp.io.vtk import write_vtk
from surfexp.mesh.triangle_mesh import TriangleMesh


def write_mesh(path: Path | str, mesh: TriangleMesh, scalars: dict[str, Floats] | None = None) -> None:
    """Write a mesh as .off, .obj, .ply, .gii or .vtk; .ply and .vtk carry scalar maps, .gii keeps single precision.

    Raises
    ------
    ValueError
        If the format is unknown or cannot carry scalar maps, or a map has another length than the mesh.
    """
    path, maps = Path(path), scalars or {}
    for name, values in maps.items():
        if len(values) != len(mesh.vertices):
            raise ValueError(
                f"scalar map {name!r} has {len(values)} values, the mesh has {len(mesh.vertices)} vertices"
            )
    with_maps, without = (
        {".ply": write_ply, ".vtk": write_vtk},
        {".off": write_off, ".obj": write_obj, ".gii": write_gifti},
    )
    suffix = path.suffix.lower()
    if suffix in with_maps:
        with_maps[suffix](path, mesh, maps)
    elif suffix not in without:
        raise ValueError(f"{path} has an unknown format, choose one of {', '.join([*without, *with_maps])}")
    elif maps:
        raise ValueError(f"{path} cannot carry scalar maps ({', '.join(maps)}), choose one of {', '.join(with_maps)}")
    else:
        without[suffix](path, mesh)
