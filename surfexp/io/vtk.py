"""Legacy VTK files, ASCII, for ParaView and its relatives."""

from __future__ import annotations

from pathlib import Path

from surfexp.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh


def write_vtk(path: Path, mesh: TriangleMesh, scalars: dict[str, Floats] | None = None) -> None:
    """Write polygonal data with one SCALARS block for each map."""
    n, m = len(mesh.vertices), len(mesh.faces)
    lines = ["# vtk DataFile Version 3.0", path.stem, "ASCII", "DATASET POLYDATA", f"POINTS {n} double"]
    lines += [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [f"POLYGONS {m} {4 * m}", *(f"3 {a} {b} {c}" for a, b, c in mesh.faces.tolist())]
    if scalars:
        lines.append(f"POINT_DATA {n}")
    for name, values in (scalars or {}).items():
        lines += [f"SCALARS {'_'.join(name.split())} double 1", "LOOKUP_TABLE default", *map(repr, values.tolist())]
    path.write_text("\n".join(lines) + "\n")
