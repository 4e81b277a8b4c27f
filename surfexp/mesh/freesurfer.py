"""FreeSurfer's geometry (lh.pial) and maps (lh.sulc), decoded by nibabel."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.mesh.triangle_mesh import Floats, Integers

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
    """(n,) values of a curvature file.

    Raises
    ------
    ValueError
        If the file is cut off.
    """
    from nibabel.freesurfer import read_morph_data

    try:
        return np.asarray(read_morph_data(path), dtype=np.float64)
    except (IndexError, TypeError) as error:
        raise ValueError(f"FreeSurfer map is cut off ({error})") from error
