"""FreeSurfer's geometry (lh.pial) and maps (lh.sulc), decoded by nibabel."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.arrays import Floats, Integers

GEOMETRY_MAGIC = (b"\xff\xff\xfe", b"\xff\xff\xff", b"\xff\xff\xfd")


def is_geometry(path: Path) -> bool:
    """Whether the file begins as FreeSurfer's triangle or quadrangle files do."""
    with path.open("rb") as stream:
        return stream.read(3) in GEOMETRY_MAGIC


def read_geometry(path: Path) -> tuple[Floats, Integers]:
    """Vertices (mm, surface coordinates) and faces.

    Raises
    ------
    ValueError
        If the file is cut off.
    """
    from nibabel.freesurfer import read_geometry as read

    try:
        vertices, faces = read(path)
    except (IndexError, TypeError, OverflowError, MemoryError) as error:
        raise ValueError(f"FreeSurfer geometry is cut off ({error})") from error
    return vertices.astype(np.float64), faces.astype(np.int64)


def read_map(path: Path) -> Floats:
    """(n,) values of a curvature file (lh.sulc, lh.curv, lh.thickness).

    Raises
    ------
    ValueError
        If the file is not one, or is cut off.
    """
    # nibabel returns as many values as it finds, without a word
    data = path.read_bytes()
    count = int.from_bytes(data[3:7], "big")
    if not data.startswith(b"\xff\xff\xff"):
        raise ValueError("it is not a FreeSurfer curvature file")
    if len(data) != 15 + 4 * count:
        raise ValueError(f"it has {len(data)} bytes, {15 + 4 * count} are needed for {count} vertices")
    return np.frombuffer(data, ">f4", count, 15).astype(np.float64)
