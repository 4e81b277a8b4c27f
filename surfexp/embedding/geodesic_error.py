"""How far a map sends points from where they belong, along the surface: the error curves of the functional-maps papers."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.fast_marching import fast_marching


def geodesic_errors(
    source: TriangleMesh,
    target_areas: Floats,
    origin: Integers,
    maps: dict[str, Integers],
    samples: int = 300,
    seed: int = 0,
) -> dict[str, Floats]:
    """Return for each map the errors at vertices of the target drawn by area, the same for all maps.

    Parameters
    ----------
    source : TriangleMesh
    target_areas : (t,) float64
        Vertex areas.
    origin : (t,) int64
        True source vertex of each target vertex.
    maps : dict of str to (t,) int64
        Source vertex that each target vertex is sent to.
    samples : int
        Vertices of the target; each costs one sweep over the source.

    Returns
    -------
    dict of str to (samples,) float64
        Distances on the source by fast marching over the square root of its area.

    Raises
    ------
    ValueError
        If a map has another length than the target, or names a vertex that the source does not have.
    """
    count = len(source.vertices)
    for name, rows in {"origin": origin, **maps}.items():
        if len(rows) != len(target_areas):
            raise ValueError(f"map {name!r} has {len(rows)} entries, the target has {len(target_areas)} vertices")
        if rows.min() < 0 or rows.max() >= count:
            raise ValueError(f"map {name!r} names vertex {rows.max()}, the source has 0..{count - 1}")
    chances = target_areas / target_areas.sum()
    chosen = np.random.default_rng(seed).choice(len(target_areas), samples, p=chances)
    errors = {name: np.empty(samples) for name in maps}
    for k, vertex in enumerate(chosen):
        distances = fast_marching(source, np.array([origin[vertex]]))
        for name, rows in maps.items():
            errors[name][k] = distances[rows[vertex]]
    return {name: values / np.sqrt(source.area) for name, values in errors.items()}


def share_within(errors: Floats, bounds: Floats) -> Floats:
    """Return for each bound the share of errors that do not exceed it."""
    return np.asarray(np.searchsorted(np.sort(errors), bounds, side="right") / len(errors))
