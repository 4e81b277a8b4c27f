"""Means and medians of maps in parcels, weighted by area."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats, Integers
from surfexp.io.medial_wall import is_outside
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import HEMISPHERES
from surfexp.tasks.given_labels import labels_on
from surfexp.tasks.given_map import MapLike, as_map
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.parcel_table import Parcels
from surfexp.tasks.part_of_task import part_for


def parcels(surface: SurfaceLike, values: MapLike, labels: str | LabelMap | ArrayLike) -> Parcels:
    """Take the mean and the median of a map in each parcel, weighted by area.

    Vertices stand for different areas, so that their plain mean depends on the mesh.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        What lies outside its mask does not count.
    values : str or (n,) or (n, c) float64
        Name of a map of the surface, or the map, or the maps of c subjects; NaN where nothing is known.
    labels : str, LabelMap, (n,) int or (n,) str
        Name of labels of the surface, or their file, or the labels. Those called unknown or medial wall are left out with a
        note, and so are vertices whose label has no name. Whole numbers are their own names, and 0 and NaN are none.

    Returns
    -------
    Parcels
        `table()`; `means`, `medians`, `areas` as arrays; `on_surface(numbers)` as a map. Of both hemispheres a parcel has one
        row on each side where it has vertices.

    Raises
    ------
    ValueError
        If a map or labels do not fit, or no vertex inside the mask is in a parcel.

    Examples
    --------
    >>> import surfexp as sx
    >>> ball = sx.shape("icosphere", levels=4)
    >>> height = ball.mesh.vertices @ [0.48, 0.36, 0.8]
    >>> found = sx.parcels(ball, height, np.where(height > 0, 1, 2))
    >>> found.names, found.means.round(2).tolist()
    (('1', '2'), [0.5, -0.5])
    """
    owner = as_surface(surface)
    given = as_map(owner, values)
    table = labels_on(owner, labels)
    left_out = [name for name in table.names.values() if is_outside(name)]
    keys = [key for key, name in table.names.items() if name not in left_out]
    part = part_for(owner)
    areas = np.zeros(part.whole_count)
    areas[part.vertices] = part.mesh.vertex_areas * part.length**2
    parcel = _numbered(table.keys, keys)
    parcel[areas == 0.0] = -1
    counted = parcel >= 0
    if not counted.any():
        raise ValueError(f"no vertex of {part.whole_count} is in a parcel: give labels with names, or another mask")
    side = np.zeros(len(parcel), np.int64) if owner.right is None else owner.right.astype(np.int64)
    used = np.unique((side * len(keys) + parcel)[counted])
    rows = np.where(counted, np.searchsorted(used, side * len(keys) + parcel), -1)
    sides = HEMISPHERES if owner.right is not None else (owner.hemisphere,)
    means, medians, unknown = _statistics(given, areas, rows, len(used))
    notes = part.notes
    if left_out:
        notes += (f"Left out: the labels {', '.join(map(repr, left_out))}.",)
    if nameless := int((~np.isin(table.keys, [*table.names]) & (areas > 0.0)).sum()):
        notes += (f"Left out: {nameless} vertices whose label has no name.",)
    empty = [table.names[key] for k, key in enumerate(keys) if k not in set((used % len(keys)).tolist())]
    if empty:
        notes += (f"{len(empty)} parcels have no vertex: {', '.join(empty[:5])}{', ...' if len(empty) > 5 else ''}.",)
    return Parcels(
        tuple(table.names[keys[k]] for k in (used % len(keys)).tolist()),
        tuple(sides[k] for k in (used // len(keys)).tolist()),
        np.bincount(rows[counted], minlength=len(used)),
        np.bincount(rows[counted], areas[counted], len(used)).astype(np.float64),
        means,
        medians,
        unknown,
        rows,
        notes,
    )


def _numbered(labels: Integers, keys: list[int]) -> Integers:
    """The place of each label among some, -1 where it is none of them."""
    place = {key: k for k, key in enumerate(keys)}
    used, inverse = np.unique(labels, return_inverse=True)
    return np.array([place.get(key, -1) for key in used.tolist()], dtype=np.int64)[inverse.ravel()]


def _statistics(values: Floats, areas: Floats, rows: Integers, count: int) -> tuple[Floats, Floats, Floats]:
    """Mean, median and unknown share of each parcel and channel, weighted by area."""
    channels = values.reshape(len(values), -1)
    found = np.full((3, count, channels.shape[1]), np.nan)
    order = np.argsort(rows, kind="stable")
    starts = np.searchsorted(rows[order], np.arange(count + 1))
    for k in range(count):
        own = order[starts[k] : starts[k + 1]]
        for c in range(channels.shape[1]):
            known = own[np.isfinite(channels[own, c])]
            found[2, k, c] = 1.0 - areas[known].sum() / areas[own].sum() if len(known) < len(own) else 0.0
            if len(known):
                found[0, k, c] = np.average(channels[known, c], weights=areas[known])
                found[1, k, c] = weighted_median(channels[known, c], areas[known])
    shape = (3, count, *values.shape[1:])
    means, medians, unknown = found.reshape(shape)
    return means, medians, unknown


def weighted_median(values: Floats, weights: Floats) -> float:
    """Return the number with half of the weight on either side; the middle of two where half lies between them.

    Parameters
    ----------
    values, weights : (n,) float64
        Weights are positive.

    Examples
    --------
    >>> weighted_median(np.array([1.0, 2.0, 9.0]), np.array([1.0, 1.0, 2.0]))
    5.5
    """
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weights[order])
    half = 0.5 * reached[-1]
    # of a sum of n weights
    rounding = len(order) * np.finfo(np.float64).eps * half
    near = np.searchsorted(reached, half - rounding, "left"), np.searchsorted(reached, half + rounding, "right")
    lower, upper = (values[order[min(place, len(order) - 1)]] for place in near)
    return float(0.5 * (lower + upper))
