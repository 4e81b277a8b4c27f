"""STL files, ASCII and binary, welded."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from surfexp.io.mesh_file import Decoded
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.welding import weld

# what follows "solid" is a name, in which any word may stand
NAMES = re.compile(rb"^[ \t]*(?:end\s?)?solid\b[^\r\n]*", re.M)
FACET = re.compile(rb"\bfacet\s+normal\b")
VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)")
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])


def read_stl(path: Path) -> Decoded:
    """Vertices and faces of an STL file; corners at exactly one position become one vertex.

    Raises
    ------
    ValueError
        If the file breaks the format or ends early.
    """
    data = path.read_bytes()
    count = int.from_bytes(data[80:84], "little")
    beyond = len(data) - 84 - RECORD.itemsize * count
    if len(data) >= 84 and beyond >= 0 and (count or not beyond):
        if beyond >= RECORD.itemsize:
            raise ValueError(
                f"it announces {count} triangles and has room for {(len(data) - 84) // RECORD.itemsize}: "
                "its count is wrong, write it again"
            )
        records = np.frombuffer(data, RECORD, count, 84)
        notes = (f"{beyond} bytes behind the last triangle are passed over.",) if beyond else ()
        return Decoded(*weld(records["corners"].astype(np.float64)), notes=notes)
    text = data.lower()
    if not text.lstrip().startswith(b"solid") or b"facet" not in text:
        raise ValueError(f"it is neither ASCII STL nor binary STL of {count} triangles ({84 + 50 * count} bytes)")
    if b"endsolid" not in text and b"end solid" not in text:
        raise ValueError("it ends before 'endsolid'")
    body = NAMES.sub(b"", text) if re.search(rb"[\r\n]", text.strip()) else text
    facets, corners = len(FACET.findall(body)), VERTEX.findall(body)
    if len(corners) != 3 * facets or not corners:
        raise ValueError(f"it has {len(corners)} vertices for {facets} triangles, three for each are needed")
    return Decoded(*weld(np.array(corners, dtype=np.float64).reshape(-1, 3, 3)))


def write_stl(path: Path, mesh: TriangleMesh) -> None:
    """Write binary STL in single precision, with the normal of each face."""
    records = np.zeros(len(mesh.faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("spare", "<u2")])
    records["normal"], records["corners"] = mesh.face_normals, mesh.vertices[mesh.faces]
    path.write_bytes(b"surfexp".ljust(80) + len(records).to_bytes(4, "little") + records.tobytes())
