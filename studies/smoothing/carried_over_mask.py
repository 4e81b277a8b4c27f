"""What a filter carries over a mask where what lies under the mask counts as 0."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface_part import surface_part
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.smoothing.geodesic_gaussian import REACH, WIDTH_OF_DEVIATION, geodesic_gaussian, near_distances
from surfexp.smoothing.methods import heat_time
from surfexp.smoothing.neighbour_mean import neighbour_mean
from surfexp.statistics.statistic import Statistic
from surfexp.variational.separable_quadratic import check_positive
from surfexp.variational.surface_flows import heat_flow

Filter = Literal["neighbour_mean", "geodesic_gaussian", "heat_flow"]
NEAR = 10.0


def carried_over_mask(mesh: TriangleMesh, inside: NDArray[np.bool_], filter: Filter, width: float) -> Statistic:
    """Smooth the map that is 1 inside a mask and 0 outside, as packages do, and once more on the part inside alone.

    Parameters
    ----------
    mesh : TriangleMesh
        In mm.
    inside : (n,) bool
    filter : {"neighbour_mean", "geodesic_gaussian", "heat_flow"}
    width : float
        Full width at half maximum in mm; a neighbour mean takes as many iterations as are as wide in the mean.

    Returns
    -------
    Statistic
        Metrics: `carried`, the share of the map's integral that lies outside afterwards, in per cent; `error_near_mask`,
        the root mean square error inside within 10 mm of the mask, in per cent of the map; the same on the part alone.

    Raises
    ------
    ValueError
        If the mask is everywhere or nowhere, or the width is not positive.
    """
    check_positive("width", width)
    if inside.all() or not inside.any():
        raise ValueError(f"the mask holds {inside.sum()} of {len(inside)} vertices: nothing can be carried over it")
    part = surface_part(mesh, inside)
    mass = fem(mesh).mass
    smoothed = _smoothed(mesh, inside.astype(float), filter, width)
    near = inside & (fast_marching(mesh, np.flatnonzero(~inside)) <= NEAR)
    alone = part.extend(_smoothed(part.mesh, np.ones(len(part.vertices)), filter, width))
    errors = [_error(mass, values, near & np.isfinite(alone)) for values in (smoothed, alone)]
    metrics = {
        "carried": 100.0 * float(mass[~inside] @ smoothed[~inside] / (mass @ smoothed)),
        "error_near_mask": errors[0],
        "error_near_mask_masked": errors[1],
    }
    return Statistic(f"{filter.replace('_', ' ')}, {width:g} mm", metrics=metrics)


def _error(mass: Floats, values: Floats, where: NDArray[np.bool_]) -> float:
    squares = (values[where] - 1.0) ** 2
    return 100.0 * float(np.sqrt(mass[where] @ squares / mass[where].sum()))


def _smoothed(mesh: TriangleMesh, values: Floats, filter: Filter, width: float) -> Floats:
    operator = fem(mesh)
    if filter == "neighbour_mean":
        return neighbour_mean(mesh.faces, values, iterations_as_wide(mesh, width))
    if filter == "geodesic_gaussian":
        distances = near_distances(mesh, REACH * width / WIDTH_OF_DEVIATION)
        return geodesic_gaussian(distances, operator.mass, values, width)
    if filter == "heat_flow":
        return heat_flow(operator, values, heat_time(width))
    raise ValueError(f"filter is {filter!r}, choose neighbour_mean, geodesic_gaussian or heat_flow")


def iterations_as_wide(mesh: TriangleMesh, width: float) -> int:
    """Return how many neighbour means reach as far as a Gaussian of a full width at half maximum, at least one.

    A mean over a vertex of degree d and its neighbours at mean square distance q has the variance q d / (d + 1) in two
    directions together; a Gaussian has twice the square of its deviation.
    """
    edges = np.concatenate([mesh.faces[:, [k, (k + 1) % 3]] for k in range(3)])
    squares = ((mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]]) ** 2).sum(axis=1)
    degree = 2.0 * len(np.unique(np.sort(edges, axis=1), axis=0)) / len(mesh.vertices)
    variance = squares.mean() * degree / (degree + 1.0)
    return max(1, round(2.0 * (width / WIDTH_OF_DEVIATION) ** 2 / float(variance)))
