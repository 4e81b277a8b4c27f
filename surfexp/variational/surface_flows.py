"""Heat flow and geodesic curvature flow of level sets on a fixed surface."""

from __future__ import annotations

import numpy as np
from scipy.sparse import diags_array

from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import ldlt
from surfexp.operators.assembly import assemble, stiffness
from surfexp.operators.calculus import gradient
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.separable_quadratic import check_positive


def heat_flow(
    operator: SurfaceOperator, values: Floats, time: float, steps: int = 10, weights: Floats | None = None
) -> Floats:
    """Return the solution of w df/dt = Laplacian f after `time`, by implicit Euler steps.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) or (n, c) float64
    time : float
        In squared units of length.
    steps : int
    weights : (n,) float64, optional
        w > 0, 1 if not given: where it is small, the map is smoothed more.

    Returns
    -------
    like `values`
        With the same mean by w, and no new extremes on Delaunay triangulations.
    """
    check_positive("time", time)
    weighted = operator.mass if weights is None else operator.mass * weights
    system = ldlt(diags_array(weighted) + time / steps * stiffness(operator))
    mass = weighted.reshape(-1, *[1] * (values.ndim - 1))
    for _ in range(steps):
        values = system.solve(mass * values)
    return values


def geodesic_curvature_flow(
    operator: SurfaceOperator, values: Floats, time: float, steps: int = 40, smoothing: float = 0.05
) -> Floats:
    """Return the solution of df/dt = |grad f| div(grad f / |grad f|): every level line moves by its geodesic curvature.

    Semi-implicit: the gradient lengths, regularised to sqrt(|G f|^2 + eps^2), are those of the last step.

    Parameters
    ----------
    operator : SurfaceOperator
    values : (n,) float64
        Best near a distance function.
    time : float
        In squared units of length.
    steps : int
    smoothing : float
        eps over the mean of |G f| at the start.

    References
    ----------
    Deckelnick, Dziuk: Error estimates for a semi-implicit fully discrete finite element scheme for the mean curvature flow of
    graphs (2000).
    """
    check_positive("time", time)
    check_positive("smoothing", smoothing)
    local = np.einsum("f,fia,fja->fij", operator.areas, operator.hat_gradients, operator.hat_gradients)
    lengths = np.linalg.norm(gradient(operator, values), axis=1)
    eps = smoothing * float(operator.areas @ lengths / operator.areas.sum())
    for _ in range(steps):
        slowness = 1.0 / np.sqrt((gradient(operator, values) ** 2).sum(axis=1) + eps**2)
        corner_share = np.repeat(operator.areas * slowness / 3.0, 3)
        mass = np.bincount(operator.faces.ravel(), corner_share, operator.vertex_count)
        matrix = assemble(operator.faces, slowness[:, None, None] * local, operator.vertex_count)
        values = ldlt(diags_array(mass) + time / steps * matrix).solve(mass * values)
    return values
