"""The trend of nodal counts against the number of the mode."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.triangle_mesh import Floats
from surfexp.statistics.statistic import Statistic

# limits of count_n / n: the mean on a rectangle (Blum, Gnutzmann and Smilansky 2002); no plane domain stays above the other
RECTANGLE_MEAN = 4.0 / np.pi**2
WINDOW = 10
PLEIJEL = 4.0 / 2.404825557695773**2


def nodal_trend(counts: Floats, name: str = "") -> Statistic:
    """Relate counts to the number of their mode, the constant one left out.

    Parameters
    ----------
    counts : (k,) float64
        Nodal numbers of the modes 1, 2, ...; at least 20.

    Returns
    -------
    Statistic
        A row for each ten modes. Columns: mode (the middle of the ten), count (their mean), ratio (count over n: mean,
        least and largest of the ten), running mean (of all ratios so far), rectangle (4 / pi^2). Metrics: mean_ratio and
        largest_ratio over the upper half of the modes, slope and exponent of the fit count = slope n^exponent.

    Raises
    ------
    ValueError
        If there are fewer than 20 counts.
    """
    if len(counts) < 20:
        raise ValueError(f"{len(counts)} counts are too few for a trend, at least 20 are needed")
    numbers = np.arange(1.0, len(counts) + 1.0)
    ratio = counts / (numbers + 1.0)
    upper = slice(len(counts) // 2, None)
    exponent, level = np.polyfit(np.log(numbers), np.log(np.maximum(counts, 1.0)), 1)
    metrics = {
        "mean_ratio": float(ratio[upper].mean()),
        "largest_ratio": float(ratio[upper].max()),
        "exponent": float(exponent),
        "slope": float(np.exp(level)),
        "over_rectangle": float(ratio[upper].mean() / RECTANGLE_MEAN),
        "pleijel": PLEIJEL,
    }
    tens = len(counts) // WINDOW
    ratios = ratio[: tens * WINDOW].reshape(tens, WINDOW)
    columns = {
        "mode": WINDOW * (np.arange(tens) + 0.5) + 0.5,
        "count": counts[: tens * WINDOW].reshape(tens, WINDOW).mean(axis=1),
        "ratio": np.stack([ratios.mean(axis=1), ratios.min(axis=1), ratios.max(axis=1)], axis=1),
        "running mean": (np.cumsum(ratio) / numbers)[WINDOW - 1 :: WINDOW],
        "rectangle": np.full(tens, RECTANGLE_MEAN),
    }
    return Statistic(f"trend of nodal counts{f' of the {name}' if name else ''}", columns, metrics=metrics)
