"""The shape of a synthetic corpus callosum: a curved midline that is known, and a width along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats

# share of the midline, turning angle in degrees from the x axis (forward), half width in mm: splenium, isthmus, body, genu, rostrum
SHARES = np.array([0.0, 0.10, 0.22, 0.34, 0.50, 0.64, 0.74, 0.82, 0.91, 1.0])
ANGLES = np.array([78.0, 52.0, 30.0, 14.0, -4.0, -24.0, -70.0, -135.0, -172.0, -182.0])
HALF_WIDTHS = np.array([4.6, 4.4, 2.6, 2.2, 2.9, 3.3, 4.4, 4.2, 2.3, 1.3])
LENGTH = 92.0
ISTHMUS, ISTHMUS_SPREAD = 0.31, 0.06
GENU = (0.64, 0.91)


@dataclass(frozen=True, eq=False)
class Callosum:
    """The shape behind a patch.

    Parameters
    ----------
    midline : (s, 2) float64
        In mm, evenly spaced, from the centre of the last disc at the splenium to that at the rostrum.
    half_width : (s,) float64
        Radii of the discs whose union the shape is, so that the midline is its medial axis.
    """

    midline: Floats
    half_width: Floats


def callosum_shape(seed: int = 0, thinning: float = 0.0, samples: int = 801) -> Callosum:
    """One random callosum.

    Length varies by 8 %, every half width by 10 % and every turning angle by 6 degrees (standard deviations, cut off at two).

    Parameters
    ----------
    seed : int
    thinning : float
        Share by which the isthmus is thinned, at 31 % of the midline, Gaussian along it with a deviation of 6 %.

    Raises
    ------
    ValueError
        If the thinning is not in 0..0.8.
    """
    if not 0.0 <= thinning <= 0.8:
        raise ValueError(f"thinning is {thinning}, it must lie in 0..0.8")
    from scipy.interpolate import PchipInterpolator

    rng = np.random.default_rng(seed)

    def varied(count: int) -> Floats:
        return np.clip(rng.normal(size=count), -2.0, 2.0)

    length = LENGTH * (1.0 + 0.08 * varied(1)[0])
    angles = np.radians(ANGLES + 6.0 * varied(len(ANGLES)))
    widths = HALF_WIDTHS * (1.0 + 0.10 * varied(len(HALF_WIDTHS)))
    share = np.linspace(0.0, 1.0, samples)
    angle = PchipInterpolator(SHARES, angles)(share)
    bump = np.exp(-0.5 * ((share - ISTHMUS) / ISTHMUS_SPREAD) ** 2)
    half_width = PchipInterpolator(SHARES, widths)(share) * (1.0 - thinning * bump)
    step = length / (samples - 1)
    path = [np.concatenate([[0.0], np.cumsum(0.5 * (f[1:] + f[:-1])) * step]) for f in (np.cos(angle), np.sin(angle))]
    return Callosum(np.stack(path, axis=1), half_width)
