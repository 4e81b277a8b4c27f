"""GIFTI files (.gii, .gii.gz): geometry and maps, decoded by nibabel."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.parsers.expat import ExpatError

import numpy as np
from numpy.typing import NDArray

from surfexp.mesh.triangle_mesh import TriangleMesh


def read_gifti_arrays(path: Path) -> list[NDArray[Any]]:
    """All data arrays of a GIFTI file, in their order: points and triangles of a surface, values of a map.

    Raises
    ------
    ValueError
        If the file is not GIFTI, is cut off or holds no array.
    """
    import nibabel
    from nibabel.filebasedimages import ImageFileError

    try:
        image = nibabel.load(path)
        arrays = [np.asarray(array.data) for array in image.darrays]
    except (ExpatError, EOFError, OSError, AttributeError, ImageFileError, ValueError) as error:
        raise ValueError(f"it is not a readable GIFTI file: {error}") from error
    if not arrays or any(array.size == 0 for array in arrays):
        raise ValueError("it is a GIFTI file without data arrays")
    return arrays


def write_gifti(path: Path, mesh: TriangleMesh) -> None:
    """Write points (float32, as the format has them) and triangles, compressed inside the XML."""
    import nibabel

    points = nibabel.gifti.GiftiDataArray(mesh.vertices.astype(np.float32), "NIFTI_INTENT_POINTSET")
    triangles = nibabel.gifti.GiftiDataArray(mesh.faces.astype(np.int32), "NIFTI_INTENT_TRIANGLE")
    nibabel.save(nibabel.gifti.GiftiImage(darrays=[points, triangles]), path)
