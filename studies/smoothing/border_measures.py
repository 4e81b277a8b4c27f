"""Where the borders of a smoothed map lie, how sharp they are, and how many there are that should not be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.skeleton.contour_geometry import contour_steps
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.skeleton.level_contours import level_contours

FAR = 10.0
PROFILE = 15.0
SQUARE = 100.0
BORDER_METRICS = {
    "border_distance": Metric("mean distance between planted and found borders, both ways", "mm", "lower"),
    "border_width": Metric(
        "distance over which the mean profile climbs from 10 to 90 % of the contrast", "mm", "lower"
    ),
    "false_border": Metric("length of found borders over 10 mm from a planted one, on 1 cm^2", "mm", "lower"),
}


def border_measures(
    mesh: TriangleMesh, operator: SurfaceOperator, values: Floats, upper: NDArray[np.bool_], levels: tuple[float, float]
) -> dict[str, float]:
    """Compare the level line half way between two levels with the border at which they were planted.

    Parameters
    ----------
    mesh : TriangleMesh
        In mm.
    operator : SurfaceOperator
    values : (n,) float64
        The smoothed map.
    upper : (n,) bool
        Where the upper level was planted.
    levels : (float, float)
        The lower and the upper level.

    Returns
    -------
    dict of str to float
        border_distance (absent where no border is found), border_width and false_border.

    Raises
    ------
    ValueError
        If one of the levels is nowhere.
    """
    if upper.all() or not upper.any():
        raise ValueError(f"the upper level is at {upper.sum()} of {len(upper)} vertices: there is no border")
    signed = signed_distance(mesh, operator, upper)
    places, lengths = border_segments(mesh, values, 0.5 * (levels[0] + levels[1]), signed)
    area = float(operator.mass.sum())
    measures = {
        "border_width": profile_width(operator, values, signed, levels),
        "false_border": SQUARE * float(lengths[np.abs(places) > FAR].sum()) / area,
    }
    found = (values > 0.5 * (levels[0] + levels[1])).astype(bool)
    if len(lengths) and lengths.sum() > 0 and found.any() and not found.all():
        there = float(lengths @ np.abs(places) / lengths.sum())
        other = signed_distance(mesh, operator, found)
        back, sizes = border_segments(mesh, upper.astype(float), 0.5, other)
        measures["border_distance"] = 0.5 * (there + float(sizes @ np.abs(back) / sizes.sum()))
    return measures


def false_border_of_noise(mesh: TriangleMesh, operator: SurfaceOperator, values: Floats, level: float) -> float:
    """Return the length, on 1 cm^2, of the lines where a map that should be 0 crosses a level or its negative."""
    lengths = [border_segments(mesh, values, sign * level, values)[1].sum() for sign in (-1.0, 1.0)]
    return SQUARE * float(sum(lengths)) / float(operator.mass.sum())


def signed_distance(mesh: TriangleMesh, operator: SurfaceOperator, inside: NDArray[np.bool_]) -> Floats:
    """(n,) distances along the surface from the border of a set of vertices, positive inside.

    The border runs half way between vertices of both sides, half an edge length from them.
    """
    half = 0.5 * operator.edge_length
    inward = fast_marching(mesh, np.flatnonzero(~inside)) - half
    outward = fast_marching(mesh, np.flatnonzero(inside)) - half
    return np.where(inside, inward, -outward)


def border_segments(mesh: TriangleMesh, values: Floats, level: float, function: Floats) -> tuple[Floats, Floats]:
    """Return a function at the middles of the segments of a level line, and the lengths of the segments."""
    if not values.min() < level < values.max():
        return np.zeros(0), np.zeros(0)
    contours = level_contours(mesh, values, np.array([level]))
    points = contours.interpolate(mesh.vertices)
    if not len(points):
        return np.zeros(0), np.zeros(0)
    steps, following = contour_steps(contours, points)
    samples = contours.interpolate(function)
    return 0.5 * (samples + samples[following]), np.linalg.norm(steps, axis=1)


def profile_width(operator: SurfaceOperator, values: Floats, signed: Floats, levels: tuple[float, float]) -> float:
    """Return the distance over which the mean of a map, by distance from the border, climbs from 10 to 90 %.

    Bins are an edge length wide, within 15 mm; what does not get so far there counts as getting so far at 15 mm.
    """
    edges = np.arange(-PROFILE, PROFILE + operator.edge_length, operator.edge_length)
    place = np.digitize(signed, edges)
    masses = np.bincount(place, operator.mass, len(edges) + 1)[1:-1]
    sums = np.bincount(place, operator.mass * values, len(edges) + 1)[1:-1]
    filled = masses > 0
    middles = 0.5 * (edges[:-1] + edges[1:])[filled]
    share = (sums[filled] / masses[filled] - levels[0]) / (levels[1] - levels[0])
    rising = np.maximum.accumulate(share)
    ends = [middles[-1] if rising[-1] < part else float(np.interp(part, rising, middles)) for part in (0.1, 0.9)]
    return float(max(ends[1] - ends[0], 0.0))
