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


def common_frame(first: SpatialFrame, second: SpatialFrame) -> tuple[SpatialFrame, tuple[str, ...]]:
    """Return what two files say alike of the space of their vertices, and in words what they say otherwise.

    Parameters
    ----------
    first, second : SpatialFrame

    Returns
    -------
    SpatialFrame
    tuple of str
    """
    same_volume = first.volume.keys() == second.volume.keys() and all(
        np.array_equal(value, second.volume[key]) for key, value in first.volume.items()
    )
    same_transforms = len(first.transforms) == len(second.transforms) and all(
        (a.source, a.target) == (b.source, b.target) and np.array_equal(a.matrix, b.matrix)
        for a, b in zip(first.transforms, second.transforms, strict=False)
    )
    lost = [] if same_volume else ["volume geometry"]
    lost += [] if same_transforms else ["coordinate transforms"]
    common = SpatialFrame(
        first.volume if same_volume else {},
        first.transforms if same_transforms else (),
        {key: value for key, value in first.metadata.items() if second.metadata.get(key) == value},
    )
    return common, (f"The hemispheres differ in {' and '.join(lost)}: left out.",) if lost else ()
