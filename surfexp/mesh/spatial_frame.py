"""Where the vertices of a surface lie, as its file says it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats


@dataclass(frozen=True, eq=False)
class CoordinateTransform:
    """A transform of vertices into another space.

    Parameters
    ----------
    source, target : str
        Names of the spaces in NIfTI, such as "NIFTI_XFORM_TALAIRACH".
    matrix : (4, 4) float64
    """

    source: str
    target: str
    matrix: Floats


@dataclass(frozen=True, eq=False)
class SpatialFrame:
    """What a file says of the space of its vertices, carried from reading to writing.

    Parameters
    ----------
    volume : mapping of str to value
        FreeSurfer's geometry of the volume (`cras`, `volume`, `voxelsize`, ...), as nibabel names it.
    transforms : tuple of CoordinateTransform
        GIFTI's coordinate transforms.
    metadata : mapping of str to str
        GIFTI's metadata of the points, such as `AnatomicalStructurePrimary`.
    """

    volume: Mapping[str, Any] = field(default_factory=dict)
    transforms: tuple[CoordinateTransform, ...] = ()
    metadata: Mapping[str, str] = field(default_factory=dict)

    def lost_in(self, format_name: str) -> str:
        """Say in one line what a format cannot hold of it; nothing where all is held.

        Parameters
        ----------
        format_name : {"FreeSurfer", "GIFTI"} or another

        Returns
        -------
        str
        """
        moved = any(not np.array_equal(t.matrix, np.eye(4)) for t in self.transforms)
        lost = ["FreeSurfer's volume geometry (cras)"] if self.volume and format_name != "FreeSurfer" else []
        lost += ["coordinate transforms"] if moved and format_name != "GIFTI" else []
        return f"{' and '.join(lost)} of the input cannot be held by this format and are left out." if lost else ""
