"""Split Bregman iterations (2.12)-(2.18), factorised once and over-relaxed; the box is a second splitting."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.sparse import diags_array

from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import ldlt
from surfexp.operators.assembly import stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.published.split_bregman import Inner, published_split_bregman
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_pock import starting_fields
from surfexp.variational.solvers.face_sweeps import bregman_update


def split_bregman(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float | None = None,
    iteration_limit: int = 5000,
    penalty: float | None = None,
    relaxation: float = 1.8,
    progress: Progress | None = None,
) -> Solution:
    """Minimise TV + H by split Bregman iterations, that is ADMM on V = grad phi.

    A quadratic H enters the linear system of (2.18), solved with lumped mass. Any other H is split off as well,
    psi = phi, and enters by its proximal map; so a box is kept exactly, and psi is returned. With a vertex-averaged operator
    the published iteration runs instead (`published_split_bregman`), its system solved directly for ROF and by one
    Gauss-Seidel sweep for Chan-Vese.

    Parameters
    ----------
    fidelity : Fidelity
    operator : SurfaceOperator
    start : Solution, optional
        Values and dual field to begin with.
    tolerance : float, optional
        Bound of the relative gap; default: that of the model.
    iteration_limit : int
    penalty : float, optional
        lambda. Default: 6 mu h^2 for a quadratic, else h^2 over three primal steps of the fidelity.
    relaxation : float
        Over-relaxation in (0, 2).
    progress : callable, optional

    References
    ----------
    Goldstein, Osher: The split Bregman method for L1-regularized problems (2009).
    Eckstein, Bertsekas: On the Douglas-Rachford splitting method (1992), for the over-relaxation.
    """
    if not 0 < relaxation < 2:
        raise ValueError(f"relaxation is {relaxation}, must lie in (0, 2); 1.8 is usual")
    if operator.averaged_gradient is not None:
        inner: Inner = "direct" if fidelity.strong_convexity > 0 else "gauss_seidel"
        published = published_split_bregman(
            fidelity,
            operator,
            start,
            tolerance=tolerance,
            iteration_limit=iteration_limit,
            penalty=penalty,
            inner=inner,
            progress=progress,
        )
        return replace(published, solver="split_bregman")
    h = operator.edge_length
    if isinstance(fidelity, SeparableQuadratic) and fidelity.is_quadratic:
        chosen = 6.0 * fidelity.strong_convexity * h**2 if penalty is None else penalty
        iterates = _quadratic_iterates(fidelity, operator, start, chosen, relaxation, iteration_limit)
    else:
        chosen = h**2 / (3.0 * fidelity.step) if penalty is None else penalty
        iterates = _split_iterates(fidelity, operator, start, chosen, relaxation, iteration_limit)
    return run_to_gap(iterates, fidelity, operator, "split_bregman", tolerance, progress)


class _Gradients:
    """V, b and the two loads of one run, updated in place."""

    def __init__(self, operator: SurfaceOperator, values: Floats, dual: Floats, penalty: float, relaxation: float):
        count = operator.vertex_count
        self.dual, self.penalty = dual, penalty
        self.load, self.pull = np.zeros(values.shape), np.zeros(values.shape)
        field, self.multiplier = np.zeros_like(dual), dual / penalty
        self._faces = (operator.faces, operator.hat_gradients, operator.areas)
        self._state = (field.reshape(len(dual), -1, 2), self.multiplier.reshape(len(dual), -1, 2))
        self._loads = (self.load.reshape(count, -1), self.pull.reshape(count, -1))
        bregman_update(*self._faces, penalty, 1.0, values.reshape(count, -1), *self._state, *self._loads)
        self._relaxation = relaxation

    def update(self, values: Floats) -> None:
        channels = values.reshape(len(values), -1)
        bregman_update(*self._faces, self.penalty, self._relaxation, channels, *self._state, *self._loads)

    def iterate(self, iteration: int, values: Floats) -> Iterate:
        np.multiply(self.multiplier, self.penalty, out=self.dual)
        return Iterate(iteration, values, self.dual, self.load)


def _quadratic_iterates(
    fidelity: SeparableQuadratic,
    operator: SurfaceOperator,
    start: Solution | None,
    penalty: float,
    relaxation: float,
    limit: int,
) -> Iterator[Iterate]:
    values, dual = starting_fields(fidelity, operator, start)
    mass = operator.mass.reshape(-1, *[1] * (values.ndim - 1))
    weight = operator.mass * fidelity.weight.reshape(len(values), -1)[:, 0]
    system = ldlt(diags_array(weight) + penalty * stiffness(operator))
    constant = mass * (fidelity.weight * fidelity.target - fidelity.slope)
    gradients = _Gradients(operator, values, dual, penalty, relaxation)
    for iteration in range(1, limit + 1):
        values = system.solve(constant + penalty * gradients.pull)
        gradients.update(values)
        yield gradients.iterate(iteration, values)


def _split_iterates(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None,
    penalty: float,
    relaxation: float,
    limit: int,
) -> Iterator[Iterate]:
    values, dual = starting_fields(fidelity, operator, start)
    mass = operator.mass.reshape(-1, *[1] * (values.ndim - 1))
    coupling = penalty / operator.edge_length**2
    system = ldlt(diags_array(coupling * operator.mass) + penalty * stiffness(operator))
    gradients = _Gradients(operator, values, dual, penalty, relaxation)
    offset = -gradients.load / (coupling * mass)
    for iteration in range(1, limit + 1):
        smooth = system.solve(coupling * mass * (values - offset) + penalty * gradients.pull)
        gradients.update(smooth)
        mixed = relaxation * smooth + (1.0 - relaxation) * values + offset
        values = fidelity.prox(mixed, 1.0 / coupling)
        offset = mixed - values
        yield gradients.iterate(iteration, values)
