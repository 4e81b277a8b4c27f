"""How far a skeleton is from a midline that is known."""

from __future__ import annotations

from surfexp.contract.arrays import Floats
from surfexp.skeleton.polyline import distance_from_line, polyline_length


def midline_errors(midline: Floats, line: Floats) -> tuple[float, float]:
    """Largest distances between a midline and the line of a skeleton, in the unit of both.

    Parameters
    ----------
    midline : (s, 3) float64
        Finely sampled.
    line : (k, 3) float64
        The contours' points along the trunk.

    Returns
    -------
    miss : float
        Of the midline from the line: large where the skeleton ends early or cuts a corner.
    excess : float
        Of the line's points from the midline, those aside that lie beyond its ends.
    """
    miss = float(distance_from_line(midline, line)[0].max())
    distances, places = distance_from_line(line, midline)
    length = polyline_length(midline)
    inside = (places > 1e-6 * length) & (places < (1.0 - 1e-6) * length)
    return miss, float(distances[inside].max(initial=0.0))
