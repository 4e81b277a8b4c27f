"""The iterates of the primal-dual method of Chambolle and Pock, with a step of its own on every face."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate
from surfexp.variational.fidelity import Fidelity
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.threaded_ascent import ThreadedAscent

CHECK_INTERVAL = 10


def starting_fields(fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None) -> tuple[Floats, Floats]:
    """Return copies of the values and the dual field to begin with, zero dual where `start` has none.

    Raises
    ------
    ValueError
        If the fidelity is not of as many vertices as the operator.
    """
    if fidelity.shape[0] != operator.vertex_count:
        raise ValueError(f"the image has {fidelity.shape[0]} values, the surface has {operator.vertex_count} vertices")
    values = fidelity.initial() if start is None else start.values.copy()
    if start is not None and start.dual is not None:
        return values, start.dual.copy()
    return values, np.zeros((len(operator.faces), *fidelity.shape[1:], 2))


def chambolle_pock_iterates(
    fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None, tau: float, limit: int, threads: int = 1
) -> Iterator[Iterate]:
    """Yield every tenth iterate of the face-based method, the last one included.

    Parameters
    ----------
    fidelity, operator, start
        As in `primal_dual`.
    tau : float
        First primal step; it falls by acceleration where the fidelity is strongly convex.
    limit : int
        Number of iterations.
    threads : int
        Over how many the sweep over the faces is spread.
    """
    values, dual = starting_fields(fidelity, operator, start)
    count = operator.vertex_count
    mass = operator.mass.reshape(-1, *[1] * (values.ndim - 1))
    mu = fidelity.strong_convexity
    ahead, load, point = values.copy(), np.zeros(values.shape), np.empty(values.shape)
    views = (ahead.reshape(count, -1), dual.reshape(len(dual), -1, 2), load.reshape(count, -1))
    sigma = 1.0 / tau
    ascent = ThreadedAscent(operator, views[0].shape[1], threads)
    try:
        for iteration in range(1, limit + 1):
            ascent(sigma, *views)
            np.divide(load, mass, out=point)
            point *= -tau
            point += values
            new = fidelity.prox(point, tau)
            momentum = 1.0 / np.sqrt(1.0 + 2.0 * mu * tau)
            np.subtract(new, values, out=ahead)
            ahead *= momentum
            ahead += new
            tau, sigma, values = tau * momentum, sigma / momentum, new
            if iteration % CHECK_INTERVAL == 0 or iteration == limit:
                yield Iterate(iteration, values, dual, load)
    finally:
        ascent.close()
