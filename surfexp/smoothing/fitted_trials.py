"""A map after many filters, and what Stein's estimate with a probe of the fitted noise says of each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.threads import in_threads
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.edge_weights import ROUNDING, edge_weighted
from surfexp.smoothing.heat_polynomial import heat_polynomials, largest_eigenvalue_bound
from surfexp.smoothing.methods import MethodName, heat_time
from surfexp.smoothing.parameter_choice import PROBE_STEP
from surfexp.variational.fidelity import Progress
from surfexp.variational.fitted_noise import FittedNoise
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.surface_flows import heat_flow

# full widths in edges, and weights of total variation without unit
WIDTHS = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.7, 4.5, 5.5, 7.0, 9.0, 12.0, 16.0)
WEIGHTS = tuple(2.0**power for power in range(3, -6, -1))
GUIDE_WIDTH = 1.5
# smaller weights are left out once the estimate has risen by this share of the variance of the noise
RISEN = 0.03
KERNEL_TOLERANCE = 1e-5
# first-order iterations over the root of the number of vertices: where they were more, Newton's method takes less time at half of
# the weight, its factors growing as that number to the power 1.5; on larger meshes two of them would take several GiB
MANY_ITERATIONS, LARGEST_NEWTON = 3.0, 400_000
# of the tolerance, which costs Newton one step more: its last one lands anywhere below
OF_NEWTON = 0.1
# time times the largest eigenvalue, beyond which implicit steps take the place of the polynomial
LONGEST_POLYNOMIAL, STEPS = 1e6, 10
# where noise has the deviation s, the best width of a kernel in two dimensions grows as its cube root
OF_KERNELS = 1.0 / 3.0


@dataclass(frozen=True, eq=False)
class Trial:
    """A map after one filter with one parameter.

    Parameters
    ----------
    method : str
        "heat_polynomial", "heat_flow" (its steps in place of the polynomial), "total_variation" or "edge_weighted_variation".
    parameter : float
        Full width at half maximum in the unit of the surface, or the weight without unit.
    values : (n,) float64
    response : (n,) float64
        Probe times the change of the result with it: its mean by area estimates the covariance of noise and result.
    at_the_end : bool
        Whether the parameter is the first or the last of its grid.
    solution : Solution, optional
        Of a convex problem, with its gap.
    """

    method: MethodName
    parameter: float
    values: Floats
    response: Floats
    at_the_end: bool
    solution: Solution | None = None


def fitted_trials(
    operator: SurfaceOperator,
    values: Floats,
    noise: FittedNoise,
    tolerance: float = 1e-3,
    seed: int = 0,
    threads: int = 1,
    progress: Progress | None = None,
) -> Iterator[Trial]:
    """Filter a map by heat kernels, total variation and edge-weighted total variation, each on its grid.

    Weights fall, and those behind the least estimate are left out: they would cost most.

    The probe b is drawn from the noise, and the response is ``b (F(y + e b) - F(y)) / e`` with e = 0.3. Total variation
    counts values by the precision 1 / s^2 of the noise at their vertex, kernels by its cube root.

    Parameters
    ----------
    operator : SurfaceOperator
        Consistent.
    values : (n,) float64
        Without outliers, of size about 1.
    noise : FittedNoise
        Of positive level.
    tolerance : float
        Of the relative gap of total variation.
    seed : int
        Of the probe.
    threads : int
        With two the map and the map with the probe are solved side by side; the bytes are the same.
    progress : callable, optional
        Receives the iteration and the gap of the map itself.

    References
    ----------
    Ramani et al.: Monte-Carlo SURE: a black-box optimization of regularization parameters (2008).
    """
    probe = noise.draw(operator, seed)
    columns = np.column_stack([values, values + PROBE_STEP * probe])

    def trial(method: MethodName, parameter: float, both: Floats, end: bool, found: Solution | None = None) -> Trial:
        response = probe * (both[:, 1] - both[:, 0]) / PROBE_STEP
        return Trial(method, parameter, np.ascontiguousarray(both[:, 0]), response, end, found)

    def minimised(part: tuple[int, SurfaceOperator, Solution | None, float]) -> Solution:
        place, own, start, mu = part
        data = rof(operator.mass, np.ascontiguousarray(columns[:, place]), mu)
        data = replace(data, weight=mu * noise.weights)
        told = progress if place == 0 else None
        if slow(start, operator.vertex_count):
            found = newton(data, own, start, tolerance=OF_NEWTON * tolerance, progress=told)
            if found.converged:
                return found
        return primal_dual(data, own, start, tolerance=tolerance, progress=told)

    edge = operator.edge_length
    method, kernels = _kernels(operator, columns, noise.weights**OF_KERNELS)
    for width, both in zip(WIDTHS, kernels, strict=True):
        yield trial(method, width * edge, both, width in (WIDTHS[0], WIDTHS[-1]))
    operators: dict[MethodName, list[SurfaceOperator]] = {"total_variation": [operator] * 2}
    if np.ptp(values) > ROUNDING:
        time = heat_time(GUIDE_WIDTH * edge)
        operators["edge_weighted_variation"] = [
            *in_threads(lambda column: edge_weighted(operator, column, time), columns.T, threads)
        ]
    share = operator.mass / operator.mass.sum()
    for method, pair in operators.items():
        last: list[Solution | None] = [None, None]
        least = np.inf
        for weight in WEIGHTS:
            mu = weight / (noise.level * edge)
            parts = [(place, own, last[place], mu) for place, own in enumerate(pair)]
            found = [*in_threads(minimised, parts, threads)]
            last = [*found]
            both = np.column_stack([part.values for part in found])
            one = trial(method, weight, both, weight in (WEIGHTS[0], WEIGHTS[-1]), found[0])
            yield one
            estimate = float(share @ ((one.values - values) ** 2 + 2.0 * one.response)) / noise.level**2
            least = min(least, estimate)
            if estimate > least + RISEN:
                break


def slow(before: Solution | None, vertex_count: int) -> bool:
    """Whether first-order iterations will be too many at half the weight of a solution, so that Newton's method is sooner done."""
    if before is None or vertex_count > LARGEST_NEWTON:
        return False
    return before.solver == "newton" or bool(before.iterations > MANY_ITERATIONS * np.sqrt(vertex_count))


def _kernels(operator: SurfaceOperator, columns: Floats, weights: Floats) -> tuple[MethodName, list[Floats]]:
    times = [heat_time(width * operator.edge_length) for width in WIDTHS]
    if times[-1] * largest_eigenvalue_bound(operator, weights) <= LONGEST_POLYNOMIAL:
        found = heat_polynomials(operator, columns, times, KERNEL_TOLERANCE, weights)
        return "heat_polynomial", [one[0] for one in found]
    return "heat_flow", [heat_flow(operator, columns, time, STEPS, weights) for time in times]
