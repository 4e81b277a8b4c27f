"""Chambolle's dual iterations as published: (2.26) for ROF, (2.29)-(2.32) for convex Chan-Vese."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.published.averaged_iterations import require_scalar
from surfexp.variational.published.consistent_audit import run_and_audit
from surfexp.variational.published.vector_pair import VectorPair
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.face_sweeps import chambolle_step

NAME = "published_chambolle"


def published_chambolle(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float | None = None,
    iteration_limit: int = 20000,
    tau: float | None = None,
    theta: float | None = None,
    inner_steps: int = 10,
    progress: Progress | None = None,
) -> Solution:
    """Run the published dual iteration with one step tau everywhere.

    Convex Chan-Vese is relaxed to min TV(phi) + theta/2 |phi - v|^2 + mu int v r with 0 <= v <= 1 and alternates between
    phi, by `inner_steps` of (2.32), and v; v is returned. It is biased unless theta is much larger than |mu r|.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        ROF or a convex Chan-Vese step.
    operator : SurfaceOperator
    start : Solution, optional
        Only its values are used: V = 0 as published.
    tolerance : float
        Bound of the relative gap, or of the relative change where the operator is not consistent.
    iteration_limit : int
        Of (2.26), or of the alternation.
    tau : float, optional
        At most 1 / |div|^2, a bound that the text omits and the default takes.
    theta : float, optional
        Default: 10 mean |mu r|.
    inner_steps : int
    progress : callable, optional

    Raises
    ------
    ValueError
        If tau exceeds its bound or the fidelity is another one.
    """
    if not isinstance(fidelity, SeparableQuadratic) or np.ptp(fidelity.weight) > 0:
        raise ValueError(f"the published dual iteration solves ROF and convex Chan-Vese, not {fidelity.name}")
    require_scalar(fidelity, operator)
    bound = 1.0 / VectorPair(operator).squared_norm()
    if tau is not None and not 0 < tau <= bound:
        raise ValueError(f"tau is {tau}, must lie in (0, 1/|div|^2 = {bound:.3g}] on this mesh")
    dual = _DualField(operator, bound if tau is None else tau)
    if fidelity.strong_convexity > 0:
        states = _denoise(fidelity, start, dual, iteration_limit)
    else:
        weight = 10.0 * float(np.abs(fidelity.slope).mean()) if theta is None else theta
        states = _segment(fidelity, start, dual, weight, inner_steps, iteration_limit)
    if operator.consistent:
        iterates = (Iterate(k, values, dual.field, dual.load) for k, values in states)
        return run_to_gap(iterates, fidelity, operator, NAME, tolerance, progress)
    return run_and_audit(states, fidelity, operator, NAME, tolerance, progress)


class _DualField:
    """The field p = -V and its load, m div V, advanced by the published step."""

    def __init__(self, operator: SurfaceOperator, tau: float):
        self.pair, self.tau = VectorPair(operator), tau
        self.field, self.load = np.zeros(self.pair.field_shape), np.zeros(operator.vertex_count)
        self.mass, self._steps = operator.mass, np.full(len(operator.faces), tau)

    def advance(self, values: Floats, weight: float) -> None:
        operator = self.pair.operator
        if operator.averaged_gradient is None:
            views = (values[:, None], self.field[:, None, :], self.load[:, None])
            chambolle_step(operator.faces, operator.hat_gradients, operator.areas, self._steps, weight, *views)
            return
        ascent = self.tau * weight * self.pair.gradient(values)
        self.field = (self.field + ascent) / (1.0 + np.linalg.norm(ascent, axis=1, keepdims=True))
        self.load = -self.mass * self.pair.divergence(self.field)


def _denoise(
    fidelity: SeparableQuadratic, start: Solution | None, dual: _DualField, limit: int
) -> Iterator[tuple[int, Floats]]:
    mu = fidelity.strong_convexity
    values = fidelity.target if start is None else start.values
    for iteration in range(1, limit + 1):
        dual.advance(values, mu)
        values = fidelity.target - dual.load / (mu * dual.mass)
        yield iteration, values


def _segment(
    fidelity: SeparableQuadratic, start: Solution | None, dual: _DualField, theta: float, inner_steps: int, limit: int
) -> Iterator[tuple[int, Floats]]:
    auxiliary = np.zeros(fidelity.shape) if start is None else start.values
    for iteration in range(1, limit + 1):
        for _ in range(inner_steps):
            dual.advance(auxiliary - dual.load / (theta * dual.mass), theta)
        values = auxiliary - dual.load / (theta * dual.mass)
        auxiliary = np.clip(values - fidelity.slope / theta, fidelity.lower, fidelity.upper)
        yield iteration, auxiliary
