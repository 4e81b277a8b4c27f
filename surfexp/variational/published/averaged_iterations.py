"""Primal-dual steps with the published pair of (1.26), (1.27) in place of a gradient and its adjoint."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Fidelity
from surfexp.variational.published.vector_pair import VectorPair, project_to_ball
from surfexp.variational.solution import Solution


def averaged_primal_dual(
    fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None, tau: float, limit: int
) -> Iterator[tuple[int, Floats]]:
    """Yield (iteration, values) of the method of Chambolle and Pock with W and its published divergence.

    Parameters
    ----------
    fidelity : Fidelity
        Of a scalar image.
    operator : SurfaceOperator
        With `averaged_gradient`.
    start : Solution, optional
        Only its values are used.
    tau : float
        First primal step.
    limit : int
        Number of iterations.
    """
    require_scalar(fidelity, operator)
    pair = VectorPair(operator)
    values = fidelity.initial() if start is None else start.values
    ahead, dual = values, np.zeros(pair.field_shape)
    sigma = 1.0 / (tau * pair.squared_norm())
    for iteration in range(1, limit + 1):
        dual = project_to_ball(dual + sigma * pair.gradient(ahead))
        new = fidelity.prox(values + tau * pair.divergence(dual), tau)
        momentum = 1.0 / np.sqrt(1.0 + 2.0 * fidelity.strong_convexity * tau)
        ahead = new + momentum * (new - values)
        tau, sigma, values = tau * momentum, sigma / momentum, new
        yield iteration, values


def require_scalar(fidelity: Fidelity, operator: SurfaceOperator) -> None:
    """Refuse several channels: the published gradient has none.

    Raises
    ------
    ValueError
        If the fidelity is not of shape (vertex_count,).
    """
    if fidelity.shape != (operator.vertex_count,):
        raise ValueError(
            f"{operator.name} is a gradient of scalar images of {operator.vertex_count} values, "
            f"{fidelity.name} has shape {fidelity.shape}: use operator fem"
        )
