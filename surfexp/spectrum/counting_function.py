"""Where an eigenvalue of given number lies: Weyl's law, corrected by inertia counts."""

from __future__ import annotations

import numpy as np


def guess_eigenvalue(number: float, area: float, counts: dict[float, int]) -> float:
    """Return about the eigenvalue below which `number` others lie.

    Weyl's law N(s) = area s / (4 pi) holds for large smooth pieces; on thin tubes, with boundaries or many components it
    does not, so where counts are known they replace it: between two of them N is interpolated in logarithms, beyond
    them extrapolated with the slope of the last two, kept between those of a line (1/2) and of a surface (1).

    Parameters
    ----------
    number : float
    area : float
        Total mass.
    counts : dict of float to int
        Known values of N; shifts that are not positive and counts of 0 are not used.
    """
    known = sorted((shift, count) for shift, count in counts.items() if shift > 0 and count > 0)
    if not known:
        empty = max((shift for shift, count in counts.items() if shift > 0), default=0.0)
        return max(4.0 * np.pi * number / area, 3.0 * empty)
    shifts, totals = np.log([s for s, _ in known]), np.log([c for _, c in known])
    wanted = np.log(max(number, 0.5))
    if totals[0] < wanted < totals[-1]:
        return float(np.exp(np.interp(wanted, totals, shifts)))
    near = 0 if wanted <= totals[0] else -1
    slope = 1.0
    if len(known) > 1 and totals[-1] > totals[0]:
        slope = float(np.clip((totals[-1] - totals[0]) / (shifts[-1] - shifts[0]), 0.5, 1.0))
    return float(np.exp(shifts[near] + (wanted - totals[near]) / slope))
