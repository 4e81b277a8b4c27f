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

    def __bool__(self) -> bool:
        """Whether anything is said."""
        moved = any(t.source != t.target or not np.array_equal(t.matrix, np.eye(4)) for t in self.transforms)
        return bool(self.volume) or moved or bool(self.metadata)
