"""Moebius transformations of the unit sphere: centring by balls inverted into themselves."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats

SMALLEST_STEP = 1e-13


def invert(points: Floats, centre: Floats) -> Floats:
    """Apply the Moebius transformation of the unit sphere that belongs to a centre inside the ball.

    eta(x) = (1 - |c|^2) (x + c) / |x + c|^2 + c, which keeps orientation and carries -c/|c| and c/|c| to themselves.

    Parameters
    ----------
    points : (n, 3) float64
        On the unit sphere.
    centre : (3,) float64
        |c| < 1.

    Raises
    ------
    ValueError
        If |c| >= 1.
    """
    size = float(centre @ centre)
    if size >= 1:
        raise ValueError(
            f"centre has length {np.sqrt(size):.4g}, a Moebius transformation of the sphere needs less than 1"
        )
    shifted = points + centre
    return (1.0 - size) * shifted / np.einsum("nd,nd->n", shifted, shifted)[:, None] + centre


def centred(points: Floats, masses: Floats, tolerance: float = 1e-10, iteration_limit: int = 100) -> Floats:
    """Move masses on the unit sphere by Moebius transformations until their centre of mass is the origin.

    Newton's method with the step halved until the centre of mass comes nearer (Baden, Crane and Kazhdan 2018). Among
    the conformal maps of a surface to the sphere that one is unique up to rotation.

    Parameters
    ----------
    points : (n, 3) float64
        On the unit sphere.
    masses : (n,) float64
        Areas on the surface.
    tolerance : float
        Length of the centre of mass at which to stop.
    iteration_limit : int

    Raises
    ------
    ValueError
        If the limit is reached, or more than half of the mass sits at one point, so that nothing centres it.
    """
    shares = masses / masses.sum()
    for _ in range(iteration_limit):
        mean = shares @ points
        if np.linalg.norm(mean) <= tolerance:
            return points
        jacobian = 2.0 * (np.eye(3) - np.einsum("n,ni,nj->ij", shares, points, points))
        step = -np.linalg.solve(jacobian, mean)
        step *= min(1.0, 0.9 / float(np.linalg.norm(step)))
        moved = invert(points, step)
        while np.linalg.norm(shares @ moved) >= np.linalg.norm(mean) and np.linalg.norm(step) > SMALLEST_STEP:
            step *= 0.5
            moved = invert(points, step)
        if np.linalg.norm(step) <= SMALLEST_STEP:
            break
        points = moved / np.linalg.norm(moved, axis=1, keepdims=True)
    raise ValueError(
        f"centre of mass stays {np.linalg.norm(shares @ points):.2g} from the origin, at most {tolerance:g} is wanted; "
        "the map crowds the surface into a point"
    )
