"""Tensor-product Lagrange interpolation on the nodes of a narrow band."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from surfexp.baselines.narrow_band import Indices, NarrowBand, locate
from surfexp.contract.arrays import Floats


@dataclass(frozen=True, eq=False)
class GridInterpolation:
    """Tri-linear or tri-cubic interpolation at fixed points.

    Attributes
    ----------
    starts : (q, (degree + 1)^2) int32
        First node of each row along z of the stencil; the row follows it in memory.
    fractions : (q, 3) float64
        Position of the point in its grid cell, 0..1 along each axis.
    """

    starts: Indices
    fractions: Floats

    def __call__(self, values: Floats) -> Floats:
        """Interpolate (k,) values at the nodes; returns (q,)."""
        return _interpolate(self.starts, self.fractions, values)

    @property
    def memory(self) -> int:
        """Bytes of the stencils."""
        return self.starts.nbytes + self.fractions.nbytes


def grid_interpolation(band: NarrowBand, points: Floats, degree: int) -> GridInterpolation:
    """Find the stencils of points in the band.

    Parameters
    ----------
    band : NarrowBand
    points : (q, 3) float64
        On the surface, or so near to it that the stencils stay within the band.
    degree : 1 or 3
        Tri-linear keeps the range of the values; tri-cubic is of fourth order and may overshoot.

    Raises
    ------
    ValueError
        If the degree is another, or a stencil leaves the band.
    """
    if degree not in (1, 3):
        raise ValueError(f"degree of grid interpolation is {degree}, choose 1 or 3")
    width = degree + 1
    scaled = (points - band.origin) / band.step
    cell = np.floor(scaled).astype(np.int64)
    first = cell - degree // 2
    shape = band.shape
    rows = [
        ((first[:, 0] + i) * shape[1] + first[:, 1] + j) * shape[2] + first[:, 2]
        for i in range(width)
        for j in range(width)
    ]
    starts = np.stack([locate(band.keys, row) for row in rows], axis=1)
    ends = np.stack([locate(band.keys, row + degree) for row in rows], axis=1)
    missing = int(((starts < 0) | (ends != starts + degree)).any(axis=1).sum())
    if missing:
        raise ValueError(
            f"{missing} of {len(points)} stencils of degree {degree} leave a band of radius "
            f"{band.radius / band.step:.3g} steps; take interpolation_radius({degree})"
        )
    return GridInterpolation(starts, scaled - cell)


@njit(cache=True, nogil=True)
def _lagrange_weights(t: float, weights: Floats) -> None:
    """Weights of the nodes 0, 1 or -1, 0, 1, 2 at t."""
    if len(weights) == 2:
        weights[0], weights[1] = 1.0 - t, t
    else:
        weights[0] = -t * (t - 1.0) * (t - 2.0) / 6.0
        weights[1] = (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0
        weights[2] = -(t + 1.0) * t * (t - 2.0) / 2.0
        weights[3] = (t + 1.0) * t * (t - 1.0) / 6.0


@njit(cache=True, nogil=True)
def _interpolate(starts: Indices, fractions: Floats, values: Floats) -> Floats:
    width = 2 if starts.shape[1] == 4 else 4
    along_x, along_y, along_z = np.empty(width), np.empty(width), np.empty(width)
    result = np.empty(len(starts))
    for q in range(len(starts)):
        _lagrange_weights(fractions[q, 0], along_x)
        _lagrange_weights(fractions[q, 1], along_y)
        _lagrange_weights(fractions[q, 2], along_z)
        total = 0.0
        for i in range(width):
            for j in range(width):
                row = 0.0
                start = starts[q, i * width + j]
                for k in range(width):
                    row += along_z[k] * values[start + k]
                total += along_x[i] * along_y[j] * row
        result[q] = total
    return result
