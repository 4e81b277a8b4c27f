"""Gradient descent on the regularised total variation, the method that the fast ones are measured against."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_pock import CHECK_INTERVAL, starting_fields
from surfexp.variational.solvers.face_sweeps import face_steps, smoothed_normals
from surfexp.variational.solvers.fista_dual import require_consistent


def gradient_descent(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float = 1e-3,
    iteration_limit: int = 20000,
    smoothing: float | None = None,
    progress: Progress | None = None,
) -> Solution:
    """Minimise sum A sqrt(|G phi|^2 + eps^2) + H by explicit steps on the first term and implicit ones on H.

    The field G phi / sqrt(|G phi|^2 + eps^2) is dual feasible, so the gap of the result under the true total variation is
    known; it does not fall below about eps times the area.

    Parameters
    ----------
    fidelity : Fidelity
    operator : SurfaceOperator
        Consistent.
    start : Solution, optional
        Only its values are used.
    tolerance : float
        Bound of the relative gap.
    iteration_limit : int
    smoothing : float, optional
        eps, a gradient. Default: 1 % of the mean gradient of the start, or of a jump of 1 across the surface.
    progress : callable, optional
    """
    require_consistent(operator, "gradient_descent")
    area = float(operator.areas.sum())
    if smoothing is None:
        values, _ = starting_fields(fidelity, operator, start)
        smoothing = 0.01 * max(total_variation(operator, values) / area, 1.0 / np.sqrt(area))
    if not smoothing > 0:
        raise ValueError(f"smoothing is {smoothing}, must be positive")
    iterates = _iterates(fidelity, operator, start, smoothing, iteration_limit)
    return run_to_gap(iterates, fidelity, operator, "gradient_descent", tolerance, progress)


def _iterates(
    fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None, smoothing: float, limit: int
) -> Iterator[Iterate]:
    values, dual = starting_fields(fidelity, operator, start)
    step = smoothing * float(face_steps(operator.hat_gradients).min())
    mass = operator.mass.reshape(-1, *[1] * (values.ndim - 1))
    load = np.zeros(values.shape)
    views = (dual.reshape(len(dual), -1, 2), load.reshape(len(load), -1))
    faces = (operator.faces, operator.hat_gradients, operator.areas)
    for iteration in range(limit + 1):
        smoothed_normals(*faces, smoothing, values.reshape(len(values), -1), *views)
        if iteration % CHECK_INTERVAL == 0 or iteration == limit:
            yield Iterate(iteration, values, dual, load)
        values = fidelity.prox(values - step * load / mass, step)
