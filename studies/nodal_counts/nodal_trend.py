"""The trend of nodal counts against the number of the mode."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.statistics.statistic import Statistic

# limits of count_n / n: the mean on a rectangle (Blum, Gnutzmann and Smilansky 2002); no plane domain stays above the other
RECTANGLE_MEAN = 4.0 / np.pi**2
WINDOW = 10
PLEIJEL = 4.0 / 2.404825557695773**2


def nodal_trend(counts: Floats, name: str = "", area: float = 0.0, perimeter: float = 0.0) -> Statistic:
    """Relate counts to the number n of their mode among all modes, the first one included.

    Parameters
    ----------
    counts : (k,) float64
        Nodal numbers of the modes in order, a constant one left out; at least 20. The first mode of all has one domain
        and every other at least two, so that the first count tells whether n starts with 1 (fixed rim) or with 2.
    area, perimeter : float
        Where the rim is fixed: of the surface, for the smooth trend of a rectangle that has them.

    Returns
    -------
    Statistic
        A row for each ten modes. Columns: mode (the middle of the ten), count (their mean), ratio (count over n: mean,
        least and largest of the ten), running mean (of all ratios so far), limit (4 / pi^2, of a rectangle) and, where
        the rim is fixed, smooth mean (its mean at these n, `rectangle_trend`). Metrics: mean_ratio and largest_ratio over
        the upper half of the modes, over_rectangle and over_smooth (mean_ratio over the limit and over the smooth mean of
        the same modes), smooth_ratio, slope and exponent of the fit count = slope n^exponent.

    Raises
    ------
    ValueError
        If there are fewer than 20 counts.
    """
    if len(counts) < 20:
        raise ValueError(f"{len(counts)} counts are too few for a trend, at least 20 are needed")
    fixed = counts[0] < 1.5
    numbers = np.arange(1.0, len(counts) + 1.0) + (0.0 if fixed else 1.0)
    ratio = counts / numbers
    upper = slice(len(counts) // 2, None)
    exponent, level = np.polyfit(np.log(numbers), np.log(np.maximum(counts, 1.0)), 1)
    mean = float(ratio[upper].mean())
    metrics = {
        "mean_ratio": mean,
        "largest_ratio": float(ratio[upper].max()),
        "exponent": float(exponent),
        "slope": float(np.exp(level)),
        "over_rectangle": mean / RECTANGLE_MEAN,
        "pleijel": PLEIJEL,
    }
    tens = len(counts) // WINDOW
    ratios = _tens(ratio)
    columns = {
        "mode": _tens(numbers).mean(axis=1),
        "count": _tens(counts).mean(axis=1),
        "ratio": np.stack([ratios.mean(axis=1), ratios.min(axis=1), ratios.max(axis=1)], axis=1),
        "running mean": (np.cumsum(ratio) / np.arange(1.0, len(ratio) + 1.0))[WINDOW - 1 :: WINDOW],
        "limit": np.full(tens, RECTANGLE_MEAN),
    }
    if fixed and area > 0.0 and perimeter > 0.0:
        smooth = rectangle_trend(numbers, area, perimeter)
        metrics |= {"smooth_ratio": float(smooth[upper].mean()), "over_smooth": mean / float(smooth[upper].mean())}
        columns["smooth mean"] = _tens(smooth).mean(axis=1)
    return Statistic(f"trend of nodal counts{f' of the {name}' if name else ''}", columns, metrics=metrics)


def rectangle_trend(numbers: Floats, area: float, perimeter: float) -> Floats:
    """Return the mean of count over n near the n-th Dirichlet mode of a rectangle, fluctuations left out.

    The modes are points (j, k) of a lattice in a quarter ellipse, j k domains each. Up to the eigenvalue x there are
    N = A x / (4 pi) - L sqrt(x) / (4 pi) + 1/4 of them (Weyl), the boundary term from the points on the axes, which
    are missing. On these j k is 0, so that the sum of the domains C = A^2 x^2 / (8 pi^4) - (L^2/4 - 2 A) x / (24 pi^2)
    has no such term (Euler and Maclaurin). The mean is (dC/dN) / n = (4 / pi^2) (1 + 3 L / (2 sqrt(4 pi A n)) + ...): the
    limit is approached from above, as slowly as 1 / sqrt(n).

    Parameters
    ----------
    numbers : (k,) float64
        n, from 1.
    area, perimeter : float
        A and L; the perimeter in the unit whose square is the area's.
    """
    # N(x) = n - 1/2, the middle of a step, is quadratic in sqrt(x)
    roots = (perimeter + np.sqrt(perimeter**2 + 16.0 * np.pi * area * (numbers - 0.75))) / (2.0 * area)
    modes = area / (4.0 * np.pi) - perimeter / (8.0 * np.pi * roots)
    domains = area**2 * roots**2 / (4.0 * np.pi**4) - (perimeter**2 / 4.0 - 2.0 * area) / (24.0 * np.pi**2)
    return np.asarray(domains / (modes * numbers))


def _tens(values: Floats) -> Floats:
    return values[: len(values) // WINDOW * WINDOW].reshape(-1, WINDOW)
