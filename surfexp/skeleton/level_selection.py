"""Where to sample a feature: evenly in value, in area or in length, or between its critical points."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.contour_geometry import contour_lengths
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.feature import checked_feature
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.simplification import simplified

Choice = Literal["uniform", "area_quantile", "arc_length", "critical"]
FINE = 4
# branches under this share of the range are noise of the boundary
SMALLEST_BRANCH = 0.01


def choose_levels(mesh: TriangleMesh, values: Floats, count: int, choice: Choice) -> Floats:
    """Increasing levels strictly inside the range of a feature.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (n,) float64
    count : int
        At least 1.
    choice : {"uniform", "area_quantile", "arc_length", "critical"}
        `uniform` (as published): equal steps of value. `area_quantile`: equal areas between levels. `arc_length`: equal mean
        distances between levels, the area between two over the length of the line. `critical`: as evenly as possible in
        value with at least one level between any two neighbouring critical values, those of branches under a hundredth of
        the range aside; more branches give way, the smallest first, if there are more gaps than levels.

    Returns
    -------
    (count,) float64
        Fewer where values coincide.

    Raises
    ------
    ValueError
        If the count or the choice is unfit, or the values are.
    """
    values = checked_feature(values, len(mesh.vertices))
    if count < 1:
        raise ValueError(f"{count} levels asked for, at least 1 is needed")
    if choice not in get_args(Choice):
        raise ValueError(f"choice of levels {choice!r} is unknown, choose one of {', '.join(get_args(Choice))}")
    # exact, and no square of it overflows
    unit = 2.0 ** np.floor(np.log2(np.abs(values).max()))
    values = values / unit
    if choice == "uniform":
        levels = np.linspace(values.min(), values.max(), count + 2)[1:-1]
    elif choice == "area_quantile":
        levels = _area_quantiles(mesh, values, (np.arange(count) + 0.5) / count)
    elif choice == "arc_length":
        levels = _equal_distances(mesh, values, count)
    else:
        levels = _between_critical_values(mesh, values, count)
    inside = levels[(levels > values.min()) & (levels <= values.max())]
    if not len(inside):
        raise ValueError(
            f"levels = {choice!r}: nearly all of the area has the value {unit * values.min():g}; choose uniform or critical"
        )
    return np.unique(unit * inside)


def _area_quantiles(mesh: TriangleMesh, values: Floats, shares: Floats) -> Floats:
    order = np.argsort(values, kind="stable")
    weights = mesh.vertex_areas[order]
    below = (np.cumsum(weights) - 0.5 * weights) / weights.sum()
    return np.interp(shares, below, values[order])


def area_below(mesh: TriangleMesh, values: Floats, levels: Floats) -> Floats:
    """(K,) area of {f < level} for each of increasing levels, exactly for a piecewise linear function."""
    corners = np.sort(values[mesh.faces], axis=1)
    return _area_below(corners, mesh.areas, levels, np.searchsorted(levels, corners[:, 0], side="right"))


@njit(cache=True, nogil=True)
def _area_below(corners: Floats, areas: Floats, levels: Floats, above_lowest: Integers) -> Floats:
    cut, whole = np.zeros(len(levels)), np.zeros(len(levels))
    for face in range(len(areas)):
        low, middle, high = corners[face]
        for k in range(above_lowest[face], len(levels)):
            level = levels[k]
            if level >= high:
                whole[k] += areas[face]
                break
            if level <= middle:
                share = (level - low) ** 2 / ((middle - low) * (high - low))
            else:
                share = 1.0 - (high - level) ** 2 / ((high - low) * (high - middle))
            cut[k] += share * areas[face]
    return cut + np.cumsum(whole)


def distances_between_levels(mesh: TriangleMesh, values: Floats, levels: Floats) -> Floats:
    """(K + 1,) mean distance from each level to the next, and from the extrema to the first and last: area over length.

    Parameters
    ----------
    levels : (K,) float64
        Increasing, inside the range of the values.
    """
    contours = level_contours(mesh, values, levels)
    lengths = np.bincount(contours.level, contour_lengths(contours, mesh.vertices), len(levels))
    areas = np.concatenate([[0.0], area_below(mesh, values, levels), [mesh.area]])
    widths = np.concatenate([lengths[:1], 0.5 * (lengths[1:] + lengths[:-1]), lengths[-1:]])
    return np.asarray(np.diff(areas) / np.maximum(widths, 1e-12 * lengths.max()))


def _equal_distances(mesh: TriangleMesh, values: Floats, count: int) -> Floats:
    fine = np.unique(_area_quantiles(mesh, values, (np.arange(FINE * count) + 0.5) / (FINE * count)))
    fine = fine[(fine > values.min()) & (fine <= values.max())]
    if not len(fine):  # nearly all of the area has one value
        fine = np.linspace(values.min(), values.max(), FINE * count + 1)[1:]
    travelled = np.concatenate([[0.0], np.cumsum(distances_between_levels(mesh, values, fine))])
    places = np.concatenate([[values.min()], fine, [values.max()]])
    return np.interp((np.arange(count) + 0.5) / count * travelled[-1], travelled, places)


def _between_critical_values(mesh: TriangleMesh, values: Floats, count: int) -> Floats:
    graph = exact_reeb_graph(mesh, values)
    threshold = SMALLEST_BRANCH * float(np.ptp(values))
    critical = np.unique(simplified(graph, threshold).values)
    while len(critical) - 1 > count and threshold < np.ptp(values):
        threshold *= 1.5
        critical = np.unique(simplified(graph, threshold).values)
    if len(critical) - 1 > count:
        raise ValueError(f"{count} levels cannot separate {len(critical)} critical values, take {len(critical) - 1}")
    gaps = np.diff(critical)
    shares = np.ones(len(gaps), dtype=np.int64)
    for _ in range(count - len(gaps)):
        shares[np.argmax(gaps / shares)] += 1
    parts = [low + gap * (np.arange(k) + 0.5) / k for low, gap, k in zip(critical[:-1], gaps, shares, strict=True)]
    return np.concatenate(parts)
