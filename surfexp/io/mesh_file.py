"""What a mesh file holds, before and after its polygons are cut into triangles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.surface_facts import SurfaceFacts


@dataclass(frozen=True)
class Decoded:
    """What a format's reader finds in a file.

    Parameters
    ----------
    vertices : (n, 3)
    polygons : (m, 3) array, or sequence of sequences of int
        Corners of each polygon, numbered from 0.
    scalars : dict of str to array
        Maps with one row a vertex.
    notes : tuple of str
        What was passed over, one sentence each.
    frame : SpatialFrame
        Where the vertices lie.
    facts : SurfaceFacts
        Unit, mask, labels and sides.
    """

    vertices: NDArray[np.generic]
    polygons: NDArray[np.generic] | Sequence[Sequence[int]]
    scalars: dict[str, Floats] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    frame: SpatialFrame = field(default_factory=SpatialFrame)
    facts: SurfaceFacts = field(default_factory=SurfaceFacts)


@dataclass(frozen=True)
class MeshFile:
    """A mesh file as it was read.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
    scalars : dict of str to (n,) or (n, c) float64
        Maps beside the geometry.
    notes : tuple of str
        What was passed over or may be read in several ways, one sentence each.
    frame : SpatialFrame
        Where the vertices lie.
    facts : SurfaceFacts
        Unit, mask, labels and sides.
    """

    vertices: Floats
    faces: Integers
    scalars: dict[str, Floats]
    notes: tuple[str, ...] = ()
    frame: SpatialFrame = field(default_factory=SpatialFrame)
    facts: SurfaceFacts = field(default_factory=SurfaceFacts)
