"""The level-set method of its time: explicit projected gradient steps on the narrow band, re-extended now and then."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from surfexp.baselines.band_energy import WEIGHTED_RADIUS, BandEnergy
from surfexp.baselines.band_result import solution_at_vertices
from surfexp.baselines.grid_interpolation import GridInterpolation, grid_interpolation
from surfexp.baselines.narrow_band import interpolation_radius, narrow_band
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Progress
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution


@dataclass(frozen=True, eq=False)
class LevelSet:
    """Gradient descent of sum w sqrt(|P D u|^2 + eps^2) + H(u) on a narrow band, as a method for convex models.

    The gradient on the surface is the projection P = 1 - n n^T of the gradient in space (Bertalmio, Cheng, Osher and
    Sapiro 2001). A step is explicit in the total variation and exact in the data term. Its size is 1.8/L, where 2/L is
    the bound of stability and L = 12 / (grid step^2 eps). The band is re-extended along normals at intervals.

    Parameters
    ----------
    energy : BandEnergy
    to_vertices : GridInterpolation
        From the band to the vertices of the mesh.
    to_closest : GridInterpolation
        From the band to the closest points of its own nodes.
    regularisation : float
        eps in units of (spread of the values) / (edge length of the mesh).
    extension_interval : float
        Time between two extensions, in units of the time in which the data term alone would carry a value across the
        spread. A fixed number of the small steps of a fine grid would let the error of the interpolation outrun the
        descent.
    tolerance : float
        Stop when the energy falls by less than this share of it between two extensions.
    step_limit : int
    progress : callable, optional
        Called with the step and the relative fall of the energy.
    """

    energy: BandEnergy
    to_vertices: GridInterpolation
    to_closest: GridInterpolation
    regularisation: float = 0.05
    extension_interval: float = 1.0
    tolerance: float = 1e-4
    step_limit: int = 20000
    progress: Progress | None = None

    @property
    def memory(self) -> int:
        """Bytes of the band, the stencils and the fields of an iteration."""
        return self.energy.band.memory + self.to_vertices.memory + self.to_closest.memory + 6 * self.energy.mass.nbytes

    def __call__(
        self, fidelity: SeparableQuadratic, operator: SurfaceOperator, start: Solution | None = None
    ) -> Solution:
        """Solve on the band and interpolate to the vertices; `start` gives values at the vertices to begin with.

        The solution has no certificate, only its energy under `operator`.
        """
        energy, problem = self.energy, self.energy.fidelity(fidelity)
        values = problem.initial() if start is None else energy.band.extend(start.values)
        values = np.clip(values, problem.lower, problem.upper)  # interpolation rounds
        spread = max(float(np.ptp(problem.target) if problem.is_quadratic else problem.upper - problem.lower), 1e-12)
        eps = self.regularisation * spread / operator.edge_length
        step = 1.8 * eps / energy.difference_bound
        duration = spread / float(np.mean(np.abs(problem.slope) + problem.weight * spread))
        interval = math.ceil(self.extension_interval * duration / step)
        data = float(energy.mass @ np.abs(problem.slope))
        load = np.empty_like(values)
        rows: list[tuple[float, float]] = []
        converged = False
        for iteration in range(self.step_limit + 1):
            length = energy.projected_load(values, eps, load)
            if iteration % interval == 0 or iteration == self.step_limit:
                rows.append((iteration, length + problem.value(values)))
                fall = (rows[-2][1] - rows[-1][1]) / max(abs(rows[-1][1]), data) if iteration else np.inf
                if self.progress is not None:
                    self.progress(iteration, fall)
                converged = iteration % interval == 0 and abs(fall) <= self.tolerance
                if converged or iteration == self.step_limit:
                    break
            values = problem.prox(values - step * load / energy.mass, step)
            if (iteration + 1) % interval == 0:
                values = np.clip(self.to_closest(values), problem.lower, problem.upper)
        reason = "energy stationary" if converged else "step limit"
        return solution_at_vertices(
            energy, self.to_vertices, fidelity, operator, values, rows, converged, reason, "level_set", self.memory
        )


def level_set(mesh: TriangleMesh, step: float, degree: int = 3) -> LevelSet:
    """Prepare the level-set method: narrow band, stencils of the extension (of `degree` 1 or 3) and of the way back.

    Parameters
    ----------
    mesh : TriangleMesh
    step : float
        Grid spacing, in the unit of the mesh.
    degree : int
    """
    band = narrow_band(mesh, step, max(WEIGHTED_RADIUS, interpolation_radius(degree)))
    return LevelSet(
        BandEnergy(band), grid_interpolation(band, mesh.vertices, 1), grid_interpolation(band, band.closest, degree)
    )
