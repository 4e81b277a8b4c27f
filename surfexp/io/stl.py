"""STL files, ASCII and binary, welded."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.welding import weld


def read_stl(path: Path) -> tuple[Floats, Integers]:
    """Vertices and faces of an STL file; corners at exactly one position become one vertex.

    Raises
    ------
    ValueError
        If the file breaks the format or ends early.
    """
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little")
    if len(data) >= 84 and len(data) == 84 + 50 * count:
        records = np.frombuffer(data, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")], count, 84)
        return weld(records["corners"].astype(np.float64))
    words = data.split()
    if words[:1] != [b"solid"] or b"facet" not in words:
        raise ValueError(f"it is neither ASCII STL nor binary STL of {count} triangles ({84 + 50 * count} bytes)")
    if b"endsolid" not in words:
        raise ValueError("it ends before 'endsolid'")
    at = np.flatnonzero(np.array(words) == b"vertex")
    if len(at) != 3 * words.count(b"facet") or (len(at) and at[-1] + 3 >= len(words)):
        raise ValueError(f"it has {len(at)} vertices for {words.count(b'facet')} triangles, three for each are needed")
    coordinates = np.array([words[k + 1 : k + 4] for k in at], dtype=np.float64)
    return weld(coordinates.reshape(-1, 3, 3))


def write_stl(path: Path, mesh: TriangleMesh) -> None:
    """Write binary STL in single precision, with the normal of each face."""
    records = np.zeros(len(mesh.faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
    records["normal"], records["corners"] = mesh.face_normals, mesh.vertices[mesh.faces]
    path.write_bytes(b"surfexp".ljust(80) + len(records).to_bytes(4, "little") + records.tobytes())
