"""What a file says of the space of its points and is not acted upon."""

from __future__ import annotations

import gzip
import re
from pathlib import Path

from surfexp.io.gifti import is_gifti

# where 3D Slicer and ITK write it: the title of .vtk, a comment of .ply and .obj, the header of .stl
HEAD = 4096
LPS = re.compile(rb"\bSPACE=LPS\b")
TRANSFORM = b"<CoordinateSystemTransformMatrix"


def space_notes(path: Path) -> tuple[str, ...]:
    """Say what a mesh file tells of its space that is not carried along, one sentence each.

    Parameters
    ----------
    path : Path
        A file that could be read.

    Returns
    -------
    tuple of str
        That x and y point the other way than FreeSurfer's and GIFTI's; which of several coordinate transforms is kept.
    """
    if is_gifti(path):
        return _several_transforms(path)
    with path.open("rb") as file:
        if not LPS.search(file.read(HEAD)):
            return ()
    return (
        "It says SPACE=LPS: x and y have the opposite sign of FreeSurfer's and GIFTI's, and are kept as they stand.",
    )


def _several_transforms(path: Path) -> tuple[str, ...]:
    data = path.read_bytes()
    if path.suffix.lower() == ".gz":
        data = gzip.decompress(data)
    points = next((array for array in data.split(b"<DataArray")[1:] if b"NIFTI_INTENT_POINTSET" in array[:HEAD]), b"")
    count = points.count(TRANSFORM)
    return (f"Its points have {count} coordinate transforms: the last is kept.",) if count > 1 else ()
