"""FreeSurfer's files: geometry (lh.pial), maps (lh.sulc, .mgh, .mgz) and labels (.label), with nibabel."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.foreign import parsing
from surfexp.io.numbers import real_array
from surfexp.mesh.triangle_mesh import TriangleMesh

GEOMETRY_MAGIC = (b"\xff\xff\xfe", b"\xff\xff\xff", b"\xff\xff\xfd")
TRIANGLES = b"\xff\xff\xfe"
# what may follow the faces: an older record, surface and command-line tags, the geometry of the volume
TAGS = (1, 2, 3, 20)
HEMISPHERES = {"lh": "left", "rh": "right"}


def is_geometry(path: Path) -> bool:
    """Whether the file begins as FreeSurfer's triangle or quadrangle files do."""
    with path.open("rb") as stream:
        return stream.read(3) in GEOMETRY_MAGIC


def hemisphere_of(path: Path) -> str:
    """Return "left" or "right" for a name that begins as FreeSurfer's do (lh., rh.), else nothing."""
    return HEMISPHERES.get(path.name.lower()[:2], "") if path.name[2:3] in (".", "_", "-") else ""


def read_geometry(path: Path) -> tuple[Floats, Integers]:
    """Vertices (mm, surface coordinates) and faces.

    Raises
    ------
    ValueError
        If the file is cut off, or its header counts fewer faces than follow it.
    """
    from nibabel.freesurfer import read_geometry as read

    _check_length(path.read_bytes())
    with parsing("FreeSurfer geometry"):
        vertices, faces = read(path)
    return vertices.astype(np.float64), faces.astype(np.int64)


def _check_length(data: bytes) -> None:
    """Hold the counts of a triangle file against its length, since a face that the header forgets would be lost.

    What follows the faces begins with a tag; anything else is a face that the header does not count.
    """
    if not data.startswith(TRIANGLES):
        return
    head = data.find(b"\n\n", 3) + 2
    if head < 2 or len(data) < head + 8:
        raise ValueError("FreeSurfer geometry has no header")
    vertices, faces = np.frombuffer(data, ">i4", 2, head).tolist()
    end = head + 8 + 12 * (vertices + faces)
    if vertices < 0 or faces < 0 or len(data) < end:
        raise ValueError(
            f"FreeSurfer geometry is cut off: {len(data)} bytes, {vertices} vertices and {faces} faces need {end}"
        )
    if len(data) > end and int.from_bytes(data[end : end + 4], "big") not in TAGS:
        raise ValueError(
            f"FreeSurfer geometry has {len(data) - end} bytes beyond its {faces} faces: the header's count is wrong"
        )


def write_freesurfer_geometry(path: Path, mesh: TriangleMesh) -> None:
    """Write geometry in single precision, as the format has it."""
    from nibabel.freesurfer import write_geometry

    write_geometry(path, mesh.vertices, mesh.faces, create_stamp="created by surfexp", volume_info=None)


def read_map(path: Path) -> Floats:
    """(n,) values of a curvature file (lh.sulc, lh.curv, lh.thickness).

    Raises
    ------
    ValueError
        If the file is not one, is cut off, or claims several values a vertex.
    """
    # nibabel returns as many values as it finds, without a word
    data = path.read_bytes()
    if not data.startswith(b"\xff\xff\xff"):
        raise ValueError("it is not a FreeSurfer curvature file")
    count, width = int.from_bytes(data[3:7], "big"), int.from_bytes(data[11:15], "big")
    if len(data) != 15 + 4 * count:
        raise ValueError(f"it has {len(data)} bytes, {15 + 4 * count} are needed for {count} vertices")
    if width != 1:
        raise ValueError(f"it claims {width} values a vertex, a curvature file has 1")
    return real_array(np.frombuffer(data, ">f4", count, 15), "the map")


def write_curvature(path: Path, values: Floats, face_count: int = 0) -> None:
    """Write (n,) values as a curvature file, in single precision; NaN, which FreeSurfer does not know, is refused.

    Raises
    ------
    ValueError
        If a value is not finite.
    """
    from nibabel.freesurfer import write_morph_data

    unknown = int((~np.isfinite(values)).sum())
    if unknown:
        raise ValueError(f"{unknown} values of {len(values)} are NaN: .mgh, .shape.gii and .dscalar.nii can say so")
    write_morph_data(path, values, fnum=face_count)


def read_volume_map(path: Path) -> Floats:
    """(n,) or (n, frames) values of a map in a .mgh or .mgz file.

    Raises
    ------
    ValueError
        If the file is unreadable, or a volume with more than one row of voxels.
    """
    import nibabel

    with parsing(".mgh file"):
        data = np.asarray(nibabel.freesurfer.load(path).dataobj)
    n = data.shape[0] if data.ndim else 0
    if data.size == 0 or any(length != 1 for length in data.shape[1:3]):
        raise ValueError(f"it is a volume of shape {data.shape}, a map has shape (n, 1, 1) or (n, 1, 1, frames)")
    values = real_array(data.reshape(n, -1), "the map")
    return values[:, 0] if values.shape[1] == 1 else values


def write_volume_map(path: Path, values: Floats) -> None:
    """Write (n,) or (n, frames) values as .mgh or .mgz in single precision, NaN included."""
    import nibabel

    shape = (len(values), 1, 1, *values.shape[1:])
    nibabel.save(nibabel.freesurfer.MGHImage(values.reshape(shape).astype(np.float32), np.eye(4)), path)


def read_vertex_list(path: Path) -> Integers:
    """Vertex numbers of a .label file, the vertices that belong to one region.

    Raises
    ------
    ValueError
        If the file is not such a list or shorter than it says.
    """
    lines = path.read_text("ascii", "replace").splitlines()
    try:
        count = int(lines[1])
        numbers = [int(line.split()[0]) for line in lines[2 : 2 + count] if line.strip()]
    except (IndexError, ValueError) as error:
        raise ValueError(f"it is not a FreeSurfer label: {error}") from error
    if len(numbers) != count:
        raise ValueError(f"it ends after {len(numbers)} of {count} vertices")
    return np.array(numbers, dtype=np.int64)


def write_vertex_list(path: Path, inside: Integers, mesh: TriangleMesh) -> None:
    """Write the vertices of one region as a .label file, with their positions."""
    places = zip(inside.tolist(), mesh.vertices[inside].tolist(), strict=True)
    rows = [f"{vertex}  {x:.6f}  {y:.6f}  {z:.6f} 0.000000" for vertex, (x, y, z) in places]
    path.write_text("\n".join(["#!ascii label, written by surfexp", str(len(inside)), *rows]) + "\n")
