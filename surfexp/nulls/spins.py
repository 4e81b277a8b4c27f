"""Nulls by random rotation of the sphere that a cortex was mapped to (Alexander-Bloch et al. 2018)."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.nulls.nearest_vertices import NearestVertices

OUTSIDE = -1
ROUND = 1e-2
MIRROR = np.diag([-1.0, 1.0, 1.0])


def random_rotations(count: int, seed: int = 0) -> Floats:
    """Return rotations of space, uniform over all of them.

    QR of Gaussian matrices with the signs of R's diagonal moved to Q; where the determinant is -1, all signs are turned.

    Parameters
    ----------
    count : int
    seed : int

    Returns
    -------
    (count, 3, 3) float64
        Orthogonal with determinant 1.
    """
    turns, triangles = np.linalg.qr(np.random.default_rng(seed).standard_normal((count, 3, 3)))
    turns = turns * np.sign(np.diagonal(triangles, axis1=1, axis2=2))[:, None, :]
    return np.asarray(turns * np.linalg.det(turns).round()[:, None, None])


def mirrored(rotations: Floats) -> Floats:
    """Return what rotations of one hemisphere are on the other, whose first coordinate has the opposite sign.

    Parameters
    ----------
    rotations : (r, 3, 3) float64

    Returns
    -------
    (r, 3, 3) float64
    """
    return np.asarray(MIRROR @ rotations @ MIRROR)


def spin_sources(sphere: Floats, rotations: Floats, part: Integers | None = None) -> Integers:
    """Return from which vertex each vertex takes its value in each spin: the one nearest to its rotated place.

    Parameters
    ----------
    sphere : (n, 3) float64
        Vertices of the whole hemisphere on a sphere about the origin.
    rotations : (r, 3, 3) float64
    part : (p,) int64, optional
        Vertices inside the mask; default: all.

    Returns
    -------
    (p, r) int64
        Numbers within the part; -1 where the nearest vertex is outside of the mask.

    Raises
    ------
    ValueError
        If the vertices do not lie on a sphere about the origin, or the part is not among them.
    """
    lengths = np.linalg.norm(sphere, axis=1)
    if not np.ptp(lengths) <= ROUND * lengths.max():
        raise ValueError(
            f"vertices lie {lengths.min():.4g} to {lengths.max():.4g} from the origin, within {ROUND:.0%} of each other is "
            "needed: give the sphere of the hemisphere"
        )
    inside = np.arange(len(sphere)) if part is None else np.asarray(part, dtype=np.int64)
    if not len(inside) or inside.min() < 0 or inside.max() >= len(sphere):
        raise ValueError(f"part has {len(inside)} vertices, at least 1 in 0..{len(sphere) - 1} is needed")
    place = np.full(len(sphere), OUTSIDE)
    place[inside] = np.arange(len(inside))
    nearest = NearestVertices.of(sphere / lengths[:, None])
    sources = np.empty((len(rotations), len(inside)), dtype=np.int64)
    for row, rotation in zip(sources, rotations, strict=True):
        row[:] = place[nearest.of_rotated(rotation)[inside]]
    return sources.T


def spun(values: Floats, sources: Integers) -> Floats:
    """Return the nulls of a map for the sources of its spins.

    Parameters
    ----------
    values : (p,) float64
        Inside the mask.
    sources : (p, r) int64
        Of `spin_sources`.

    Returns
    -------
    (p, r) float64
        NaN where a value would come from outside of the mask.

    Raises
    ------
    ValueError
        If there is not one value for each vertex.

    References
    ----------
    Alexander-Bloch et al.: On testing for spatial correspondence between maps of human brain structure and function
    (2018).
    """
    if values.shape != sources.shape[:1]:
        raise ValueError(f"map has shape {values.shape}, the spins are of {len(sources)} vertices")
    return np.where(sources == OUTSIDE, np.nan, values[sources])
