"""Meshes in a length of their own, so that products of several lengths neither overflow nor vanish in double precision."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh

# between these, products of eight lengths have all their digits
SMALL, LARGE = 1e-25, 1e25


def length_scale(vertices: Floats) -> float:
    """Return the power of two by which coordinates have to be divided; 1 where they are of ordinary size.

    Parameters
    ----------
    vertices : (n, 3) float64
        Those that are not finite do not count.

    Returns
    -------
    float
        The division is exact.

    Examples
    --------
    >>> length_scale(np.array([[1.0, 2.0, 3.0]])), length_scale(np.array([[0.0, 0.0, 1e100]])) == 2.0**332
    (1.0, True)
    """
    largest = float(np.abs(vertices).max(initial=0.0))
    if not np.isfinite(largest):
        largest = float(np.abs(vertices[np.isfinite(vertices)]).max(initial=0.0))
    return 1.0 if largest == 0.0 or SMALL <= largest <= LARGE else float(2.0 ** np.floor(np.log2(largest)))


def scaled(mesh: TriangleMesh) -> tuple[TriangleMesh, float]:
    """Return a mesh of ordinary size, and the length that its unit has on the mesh that is given.

    Parameters
    ----------
    mesh : TriangleMesh

    Returns
    -------
    TriangleMesh
        The one that is given where its size is ordinary.
    float
        As `length_scale`.
    """
    scale = length_scale(mesh.vertices)
    return (mesh, 1.0) if scale == 1.0 else (TriangleMesh(mesh.vertices / scale, mesh.faces), scale)
