"""FreeSurfer's files: geometry (lh.pial), maps (lh.sulc, .mgh, .mgz) and labels (.label), with nibabel."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.foreign import parsing
from surfexp.io.numbers import real_array
from surfexp.mesh.triangle_mesh import TriangleMesh

GEOMETRY_MAGIC = (b"\xff\xff\xfe", b"\xff\xff\xff", b"\xff\xff\xfd")
TRIANGLES = b"\xff\xff\xfe"
# what may follow the faces: an older record, surface and command-line tags, the geometry of the volume
OLD_SPACE, VOLUME = 2, 20
TAGS = (1, OLD_SPACE, 3, VOLUME)
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

    data = path.read_bytes()
    _check_length(data)
    if data.startswith(TRIANGLES):
        head = _end_of_stamp(data)
        count, corners = np.frombuffer(data, ">i4", 2, head).tolist()
        points = np.frombuffer(data, ">f4", 3 * count, head + 8).reshape(-1, 3)
        triangles = np.frombuffer(data, ">i4", 3 * corners, head + 8 + 12 * count).reshape(-1, 3)
        return points.astype(np.float64), triangles.astype(np.int64)
    with parsing("FreeSurfer geometry"):
        vertices, faces = read(path)
    return vertices.astype(np.float64), faces.astype(np.int64)


def read_volume_geometry(path: Path) -> dict[str, Any]:
    """Return the geometry of the volume behind the faces, as nibabel names it; empty where there is none that it reads.

    `head` is how it begins: 20, or 2, whether the coordinates are the scanner's (useRealRAS), and 20.
    """
    from nibabel.freesurfer import read_geometry as read

    data = path.read_bytes()
    if not data.startswith(TRIANGLES):
        return {}
    head = _end_of_stamp(data)
    vertices, faces = np.frombuffer(data, ">i4", 2, head).tolist()
    end = head + 8 + 12 * (vertices + faces)
    words = np.frombuffer(data[end : end + 12], ">i4").tolist() if len(data) >= end + 12 else []
    # nibabel knows the geometry of the volume alone among what may follow
    if words[:1] not in ([OLD_SPACE], [VOLUME]):
        return {}
    said = words if words[0] == OLD_SPACE else words[:1]
    with warnings.catch_warnings(), tempfile.TemporaryDirectory() as folder:
        warnings.simplefilter("ignore")
        # and knows coordinates of the surface alone
        known = Path(folder) / "geometry"
        known.write_bytes(data[:head] + bytes(8) + np.array([VOLUME], ">i4").tobytes() + data[end + 4 * len(said) :])
        try:
            found = read(known, read_metadata=True)[2]
        except (OSError, ValueError, IndexError):
            return {}
    return {**found, "head": np.array(said)} if found else {}


def _check_length(data: bytes) -> None:
    """Hold the counts of a triangle file against its length, since a face that the header forgets would be lost.

    What follows the faces begins with a tag; anything else is a face that the header does not count.
    """
    if not data.startswith(TRIANGLES):
        return
    head = _end_of_stamp(data)
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


def _end_of_stamp(data: bytes) -> int:
    """Return where the counts begin: behind two ends of line, or behind one, as some versions wrote it."""
    first = data.find(b"\n", 3) + 1
    head = first + 1 if data[first : first + 1] == b"\n" else first
    if not first or len(data) < head + 8:
        raise ValueError("FreeSurfer geometry has no header")
    return head


def write_freesurfer_geometry(path: Path, mesh: TriangleMesh, volume: Mapping[str, Any] | None = None) -> None:
    """Write geometry in single precision, as the format has it, with the geometry of the volume as nibabel names it."""
    from nibabel.freesurfer import write_geometry

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of the scanner's coordinates, which nibabel writes all the same
        write_geometry(
            path,
            mesh.vertices,
            mesh.faces,
            create_stamp="created by surfexp",
            volume_info=dict(volume) if volume else None,
        )


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


def is_old_map(path: Path) -> bool:
    """Whether the length of a file is that of FreeSurfer's old curvature format: two counts of 3 bytes, then 2 a vertex."""
    with path.open("rb") as stream:
        count = int.from_bytes(stream.read(3), "big")
    return count > 0 and path.stat().st_size == 6 + 2 * count


def read_old_map(path: Path) -> Floats:
    """(n,) values of a curvature file in the old format, hundredths in two bytes each."""
    data = path.read_bytes()
    return real_array(np.frombuffer(data, ">i2", int.from_bytes(data[:3], "big"), 6) / 100.0, "the map")


def read_ascii_geometry(path: Path) -> tuple[Floats, Integers]:
    """Vertices and faces of an ASCII surface (.asc of mris_convert); the ripped flag of each is left out.

    Raises
    ------
    ValueError
        If the file ends early.
    """
    rows = _ascii_rows(path)
    if not rows or len(rows[0]) != 2:
        raise ValueError("it is no ASCII surface of FreeSurfer: its first row has no two counts")
    vertices, faces = map(int, rows[0])
    if vertices < 0 or faces < 0 or len(rows) != 1 + vertices + faces:
        raise ValueError(f"it has {len(rows) - 1} rows for {vertices} vertices and {faces} faces")
    points = np.array([row[:3] for row in rows[1 : 1 + vertices]], dtype=np.float64)
    return points, np.array([row[:3] for row in rows[1 + vertices :]], dtype=np.int64)


def read_ascii_map(path: Path) -> Floats:
    """(n,) values of an ASCII map (.asc of mris_convert): rows of vertex, x, y, z, value.

    Raises
    ------
    ValueError
        If a row has another length, or vertices are not counted from 0.
    """
    rows = _ascii_rows(path)
    if not rows or any(len(row) != 5 for row in rows):
        raise ValueError("it is no ASCII map of FreeSurfer, which has five numbers a row: vertex, x, y, z, value")
    table = np.array(rows, dtype=np.float64)
    if not np.array_equal(table[:, 0], np.arange(len(table))):
        raise ValueError("its vertices are not counted from 0 in order")
    return real_array(table[:, 4].copy(), "the map")


def _ascii_rows(path: Path) -> list[list[str]]:
    lines = path.read_text("ascii", "replace").splitlines()
    return [words for line in lines if (words := line.split("#")[0].split())]


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
    """(n,) or (n, frames) values of a map in a .mgh, .mgz or NIfTI file of one row of voxels.

    Raises
    ------
    ValueError
        If the file is unreadable, or a volume with more than one row of voxels.
    """
    import nibabel

    folded = path.name.lower().endswith((".nii", ".nii.gz"))
    with parsing("NIfTI file" if folded else ".mgh file"):
        image = nibabel.load(path) if folded else nibabel.freesurfer.load(path)
        data = np.asarray(image.dataobj)
    folded = folded and data.shape[1:2] == (1,)
    space = data.shape[:3]
    # mri_convert folds rows that are too long for NIfTI into (a, 1, b), the first axis fastest
    if data.size == 0 or sum(length != 1 for length in space) > (2 if folded else 1):
        raise ValueError(
            f"it is a volume of shape {data.shape}, a map has one row of voxels: (n, 1, 1) or (n, 1, 1, frames); "
            "sample it on the surface first (mri_vol2surf)"
        )
    values = real_array(data.reshape(int(np.prod(space)), -1, order="F"), "the map")
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
