"""A modern implicit method: a primal-dual iteration on the closest-point extension of the problem."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.baselines.band_energy import WEIGHTED_RADIUS, BandEnergy
from surfexp.baselines.band_result import solution_at_vertices
from surfexp.baselines.grid_interpolation import GridInterpolation, grid_interpolation
from surfexp.baselines.narrow_band import narrow_band
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Progress
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution

CHECK_INTERVAL = 20


@dataclass(frozen=True, eq=False)
class ClosestPoint:
    """Chambolle and Pock's iteration for sum w |D u| + H(u) on a narrow band, as a method for convex models.

    By the closest-point principle (Ruuth and Merriman 2008) the gradient in space of a function that is constant along
    normals is its gradient on the surface, so no projection is needed. The data are extended by closest points; the
    full gradient then keeps the minimiser nearly constant along normals (`normal_variation` says how nearly), and the
    problem on the band is convex with a duality gap of its own, on which the iteration stops. It is accelerated where H
    is strongly convex.

    Parameters
    ----------
    energy : BandEnergy
    to_vertices : GridInterpolation
    tolerance : float
        Bound of the relative gap on the band.
    iteration_limit : int
    progress : callable, optional
        Called with the iteration and the relative gap.
    """

    energy: BandEnergy
    to_vertices: GridInterpolation
    tolerance: float = 1e-4
    iteration_limit: int = 20000
    progress: Progress | None = None

    @property
    def memory(self) -> int:
        """Bytes of the band, the stencils and the fields of an iteration."""
        return self.energy.band.memory + self.to_vertices.memory + 9 * self.energy.mass.nbytes

    def __call__(
        self, fidelity: SeparableQuadratic, operator: SurfaceOperator, start: Solution | None = None
    ) -> Solution:
        """Solve on the band and interpolate to the vertices; `start` gives values at the vertices to begin with.

        The certificate on the band does not carry over to the surface: the solution has only its energy under
        `operator`, and the gap of the band among its metrics.
        """
        energy, problem = self.energy, self.energy.fidelity(fidelity)
        values = problem.initial() if start is None else energy.band.extend(start.values)
        tau, mu = problem.step, problem.strong_convexity
        sigma = 1.0 / (energy.difference_bound * tau)
        ahead, load = values.copy(), np.empty_like(values)
        dual = np.zeros((len(values), 3))
        rows: list[tuple[float, float]] = []
        gap = np.inf
        for iteration in range(1, self.iteration_limit + 1):
            energy.dual_ascent(sigma, ahead, dual, load)
            new = problem.prox(values - tau * load / energy.mass, tau)
            momentum = 1.0 / np.sqrt(1.0 + 2.0 * mu * tau)
            ahead = new + momentum * (new - values)
            tau, sigma, values = tau * momentum, sigma / momentum, new
            if iteration % CHECK_INTERVAL == 0 or iteration == self.iteration_limit:
                primal = energy.total_variation(values) + problem.value(values)
                bound = problem.dual_value(load)
                gap = (primal - bound) / problem.gap_scale(primal, bound)
                rows.append((iteration, primal))
                if self.progress is not None:
                    self.progress(iteration, gap)
                if gap <= self.tolerance:
                    break
        converged = bool(gap <= self.tolerance)
        reason = "gap on the band below tolerance" if converged else "iteration limit"
        solution = solution_at_vertices(
            energy, self.to_vertices, fidelity, operator, values, rows, converged, reason, "closest_point", self.memory
        )
        solution.metrics["band_gap"] = float(gap)
        return solution


def closest_point(mesh: TriangleMesh, step: float) -> ClosestPoint:
    """Prepare the closest-point method: narrow band and the stencils of the tri-linear way back to the vertices.

    Parameters
    ----------
    mesh : TriangleMesh
    step : float
        Grid spacing, in the unit of the mesh.
    """
    band = narrow_band(mesh, step, WEIGHTED_RADIUS)
    return ClosestPoint(BandEnergy(band), grid_interpolation(band, mesh.vertices, 1))
