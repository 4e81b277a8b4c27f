"""A synthetic functional map on a callosum: smooth noise, and a bump at a known place along and across the midline."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats

from .callosum_shape import Callosum

PLACE, SPREAD = (0.60, 0.70), (0.06, 0.15)
WAVES, WAVELENGTH = 24, 14.0


def midline_coordinates(points: Floats, shape: Callosum) -> tuple[Floats, Floats]:
    """Place along the midline and across it.

    Parameters
    ----------
    points : (n, 2) float64
    shape : Callosum

    Returns
    -------
    along : (n,) float64
        Share of the midline's length at its nearest sample.
    across : (n,) float64
        0 on the left edge as the midline runs, 0.5 on it, 1 on the right edge; a little beyond where the edge is jagged.
    """
    from scipy.spatial import cKDTree

    nearest = cKDTree(shape.midline).query(points)[1]
    ahead = np.gradient(shape.midline, axis=0)[nearest]
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    offset = points - shape.midline[nearest]
    leftward = ahead[:, 0] * offset[:, 1] - ahead[:, 1] * offset[:, 0]
    return nearest / (len(shape.midline) - 1.0), 0.5 - 0.5 * leftward / shape.half_width[nearest]


def planted_map(points: Floats, shape: Callosum, height: float, seed: int) -> Floats:
    """Smooth Gaussian noise of deviation 1 with waves of 14 mm, and a Gaussian bump of some height at (0.60, 0.70).

    The bump's deviations are 0.06 along and 0.15 across.

    Parameters
    ----------
    points : (n, 2) float64
        In mm.
    shape : Callosum
    height : float
        Of the bump, in deviations of the noise.
    seed : int
        Of the noise.
    """
    rng = np.random.default_rng([seed, 5])
    angles, phases = rng.uniform(0.0, 2.0 * np.pi, (2, WAVES))
    frequencies = 2.0 * np.pi / WAVELENGTH * np.stack([np.cos(angles), np.sin(angles)])
    noise = np.sqrt(2.0 / WAVES) * np.cos(points @ frequencies + phases).sum(axis=1)
    along, across = midline_coordinates(points, shape)
    square = ((along - PLACE[0]) / SPREAD[0]) ** 2 + ((across - PLACE[1]) / SPREAD[1]) ** 2
    return np.asarray(noise + height * np.exp(-0.5 * square))
