"""Total generalised variation on the cup against an interior-point solver and primal-dual steps."""

from __future__ import annotations

from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np

from audits.benchmarks.interior_point import Conic
from audits.benchmarks.line import Line, not_installed, race
from audits.benchmarks.measurement import measure, measure_both
from audits.benchmarks.scenes import cup_scene
from surfexp.contract.arrays import Floats
from surfexp.operators.fem import fem
from surfexp.variational.generalised_variation import GeneralisedVariation
from surfexp.variational.models.tgv import TGV
from surfexp.variational.solvers.generalised_primal_dual import generalised_primal_dual
from surfexp.variational.solvers.generalised_splitting import generalised_splitting

GAP, COARSE_GAP = 1e-4, 1e-3
CONIC_TOLERANCES = (1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
STEPS = (0.003, 0.01, 0.03)


def warm_up() -> None:
    """Compile what the lines use."""
    generalised_splitting(_problem(2000), tolerance=1e-1)


def lines(quick: bool) -> list[Line]:
    """Return the line against CLARABEL and the line against primal-dual steps."""
    count = 2000 if quick else 10000
    return [_against_conic(count), _against_primal_dual(count)]


def _problem(count: int) -> GeneralisedVariation:
    scene = cup_scene(count)
    return TGV().problem(scene.image, fem(scene.surface.mesh))


def _against_conic(count: int) -> Line:
    work, rival = f"total generalised variation, {count:,} V to {GAP:g}", "CLARABEL (stated in CVXPY) to the same gap"
    if missing := [package for package in ("cvxpy", "clarabel") if find_spec(package) is None]:
        return not_installed(work, rival, 2.0, ", ".join(missing))
    problem = _problem(count)
    conic = _Conic(problem)
    tolerance = next((t for t in CONIC_TOLERANCES if conic.relative_gap(conic.solve(t)) <= GAP), CONIC_TOLERANCES[-1])
    # what both factorise is made anew in each run
    ours = partial(lambda: generalised_splitting(_problem(count), tolerance=GAP).solution)
    (found, cost), (theirs, their_cost) = measure_both(ours, partial(conic.solve, tolerance))
    gap = conic.relative_gap(theirs)
    accuracy = f"gaps over the energy: ours {found.relative_gap:.1e}, rival {gap:.1e} with its tolerance {tolerance:g}"
    note = "CVXPY's own work is not counted, ours with assembly and certificates"
    fair = found.converged and gap <= GAP
    return race(work, rival, 2.0, cost, their_cost, accuracy, fair=fair, note=note)


def _against_primal_dual(count: int) -> Line:
    work, rival = f"total generalised variation, {count:,} V to {COARSE_GAP:g}", "primal-dual steps, preconditioned"
    problem = _problem(count)
    scale = float(problem.fidelity.target.std()) / problem.operator.edge_length

    def primal_dual(step: float) -> Any:
        return generalised_primal_dual(_problem(count), tolerance=COARSE_GAP, step=step * scale).solution

    best = min(STEPS, key=lambda step: measure(partial(primal_dual, step), 1)[1].cpu)
    ours = partial(lambda: generalised_splitting(_problem(count), tolerance=COARSE_GAP).solution)
    (found, cost), (theirs, their_cost) = measure_both(ours, partial(primal_dual, best))
    accuracy = (
        f"gaps ours {found.relative_gap:.1e} in {found.iterations} iterations, rival {theirs.relative_gap:.1e} in "
        f"{theirs.iterations}, the best of steps {', '.join(map(str, STEPS))}"
    )
    return race(work, rival, 2.0, cost, their_cost, accuracy, fair=found.converged and theirs.converged)


class _Conic(Conic):
    """Total generalised variation."""

    def __init__(self, problem: GeneralisedVariation) -> None:
        import cvxpy as cp

        self._given = problem
        self._unknowns, field = cp.Variable(problem.forms.shape[1]), cp.Variable(problem.forms.shape[0])
        self._link = field == problem.forms @ self._unknowns
        rows = cp.reshape(field, (len(problem.operator.areas), 6), order="C")
        parts = cp.norm(rows[:, :2], 2, axis=1) + cp.norm(rows[:, 2:], 2, axis=1)
        roots = np.sqrt(0.5 * problem.operator.mass * problem.fidelity.weight)
        values = self._unknowns[: len(roots)]
        data = cp.sum_squares(cp.multiply(roots, values) - roots * problem.fidelity.target)
        super().__init__(cp.Problem(cp.Minimize(problem.operator.areas @ parts + data), [self._link]))

    def relative_gap(self, found: Any) -> float:
        """Return the relative gap of a result of `solve`, certified as ours is."""
        self.unpack(found)
        dual: Floats = self._link.dual_value / np.repeat(self._given.operator.areas, 6)
        # the sign of a dual value is a convention: the one that proves more
        gaps = [
            self._given.certify(self._unknowns.value, self._given.feasible(sign * dual)).relative_gap
            for sign in (1.0, -1.0)
        ]
        return float(min(gaps))
