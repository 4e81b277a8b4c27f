"""The primal-dual method of Chambolle and Pock."""

from __future__ import annotations

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.own_unit import in_own_unit
from surfexp.variational.published.averaged_iterations import averaged_primal_dual
from surfexp.variational.published.consistent_audit import run_and_audit
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.chambolle_pock import chambolle_pock_iterates


@in_own_unit
def primal_dual(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float | None = None,
    iteration_limit: int = 20000,
    step: float | None = None,
    threads: int = 1,
    progress: Progress | None = None,
) -> Solution:
    """Minimise TV + H by the primal-dual method, accelerated where H is strongly convex.

    With a vertex-averaged operator the same steps are taken with W and its published divergence, which minimise nothing:
    `tolerance` then bounds the relative change, and the result carries the gap under the consistent energy.

    Parameters
    ----------
    fidelity : Fidelity
    operator : SurfaceOperator
    start : Solution, optional
        Values and dual field to begin with.
    tolerance : float, optional
        Bound of the relative gap; default: that of the model.
    iteration_limit : int
    step : float, optional
        First primal step tau; the dual one is 1/tau times the step of the face. Default: `fidelity.step`.
    threads : int
        Over how many the sweep over the faces is spread; for large meshes in a script, since the workflow gives every core a
        stage of its own. A vertex-averaged operator has no such sweep.
    progress : callable, optional

    References
    ----------
    Chambolle, Pock: A first-order primal-dual algorithm for convex problems with applications to imaging (2011).
    """
    tau = fidelity.step if step is None else step
    if operator.averaged_gradient is not None:
        states = averaged_primal_dual(fidelity, operator, start, tau, iteration_limit)
        return run_and_audit(states, fidelity, operator, "primal_dual", tolerance, progress)
    iterates = chambolle_pock_iterates(fidelity, operator, start, tau, iteration_limit, threads)
    return run_to_gap(iterates, fidelity, operator, "primal_dual", tolerance, progress)
