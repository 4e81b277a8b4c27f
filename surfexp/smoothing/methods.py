"""Ways to smooth a map on a surface, each with one parameter and its grid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Literal

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.edge_weights import edge_weighted
from surfexp.smoothing.geodesic_gaussian import REACH, WIDTH_OF_DEVIATION, geodesic_gaussian, near_distances
from surfexp.smoothing.heat_polynomial import heat_polynomial
from surfexp.smoothing.neighbour_mean import neighbour_mean
from surfexp.smoothing.parameter_choice import Smoother
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.variational.generalised_variation import GeneralisedVariation
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.generalised_splitting import generalised_splitting
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.surface_flows import heat_flow

MethodName = Literal[
    "none",
    "neighbour_mean",
    "geodesic_gaussian",
    "heat_flow",
    "heat_polynomial",
    "truncated_modes",
    "total_variation",
    "edge_weighted_variation",
    "generalised_variation",
]
ITERATIONS = tuple(2.0**power for power in range(9))
WIDTHS = (2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0)
COUNTS = (10.0, 20.0, 50.0, 100.0, 200.0, 400.0, 800.0)
WEIGHTS = tuple(2.0 ** (0.5 * power) for power in range(-6, 5))
COARSE_WEIGHTS = tuple(2.0**power for power in range(-2, 2))
GUIDE_WIDTH = 4.0
RATIO = 2.0


@dataclass(eq=False)
class Methods:
    """What the methods share on one surface; each `smoother` reads what it needs.

    Parameters
    ----------
    mesh : TriangleMesh
        The part that is smoothed, such as a cortex without its medial wall.
    operator : SurfaceOperator
        Of its triangles, consistent.
    noise : float
        Standard deviation of the noise, in the unit of the maps: scales the weights.
    eigensystem : EigenSystem, optional
        For `truncated_modes`.
    tolerance, generalised_tolerance : float
        Of the relative gap, for total variation with and without weights, and for the generalised one.
    """

    mesh: TriangleMesh
    operator: SurfaceOperator
    noise: float
    eigensystem: EigenSystem | None = None
    tolerance: float = 1e-3
    generalised_tolerance: float = 1e-2
    largest_gap: float = 0.0
    all_converged: bool = True

    def smoother(self, name: MethodName) -> tuple[Smoother, tuple[float, ...]]:
        """Return a function of (n, c) maps and a parameter, and the parameter's grid.

        The parameter is a number of iterations, a full width at half maximum in the unit of the surface, a number of modes,
        or a weight without unit, mu = weight / (noise h), of which small ones smooth more.

        Raises
        ------
        ValueError
            If the name is unknown, or modes are asked for without an eigensystem.
        """
        by_columns: dict[str, Callable[[Floats, float], Solution]] = {
            "total_variation": self._total_variation,
            "edge_weighted_variation": self._edge_weighted,
            "generalised_variation": self._generalised,
        }
        if name in by_columns:
            grid = COARSE_WEIGHTS if name == "generalised_variation" else WEIGHTS
            return partial(self._columnwise, by_columns[name]), grid
        linear: dict[str, tuple[Smoother, tuple[float, ...]]] = {
            "none": (lambda maps, _: maps, (0.0,)),
            "neighbour_mean": (lambda maps, steps: neighbour_mean(self.mesh.faces, maps, int(steps)), ITERATIONS),
            "geodesic_gaussian": (self._gaussian, WIDTHS),
            "heat_flow": (lambda maps, width: heat_flow(self.operator, maps, heat_time(width)), WIDTHS),
            "heat_polynomial": (
                lambda maps, width: heat_polynomial(self.operator, maps, heat_time(width))[0],
                WIDTHS,
            ),
            "truncated_modes": (self._truncated, self._counts()),
        }
        if name not in linear:
            raise ValueError(f"method is {name!r}, choose {', '.join([*linear, *by_columns])}")
        return linear[name]

    @cached_property
    def distances(self) -> csr_array:
        """Of all pairs within the reach of the widest Gaussian."""
        return near_distances(self.mesh, REACH * WIDTHS[-1] / WIDTH_OF_DEVIATION)

    def _gaussian(self, maps: Floats, width: float) -> Floats:
        return geodesic_gaussian(self.distances, self.operator.mass, maps, width)

    def _counts(self) -> tuple[float, ...]:
        known = np.inf if self.eigensystem is None else len(self.eigensystem.values)
        return tuple(count for count in COUNTS if count <= known)

    def _truncated(self, maps: Floats, count: float) -> Floats:
        if self.eigensystem is None:
            raise ValueError("truncated_modes needs an eigensystem, there is none: give one of 800 modes")
        vectors = self.eigensystem.vectors[:, : int(count)]
        return np.asarray(vectors @ (vectors.T @ (mass_matrix(self.operator) @ maps)))

    def _columnwise(self, minimise: Callable[[Floats, float], Solution], maps: Floats, weight: float) -> Floats:
        solutions = [minimise(np.ascontiguousarray(column), weight) for column in maps.T]
        gaps = [np.inf if found.relative_gap is None else found.relative_gap for found in solutions]
        self.largest_gap = max(self.largest_gap, *gaps)
        self.all_converged &= all(found.converged for found in solutions)
        return np.column_stack([found.values for found in solutions])

    def _mu(self, weight: float) -> float:
        return weight / (self.noise * self.operator.edge_length)

    def _total_variation(self, values: Floats, weight: float) -> Solution:
        return primal_dual(rof(self.operator.mass, values, self._mu(weight)), self.operator, tolerance=self.tolerance)

    def _edge_weighted(self, values: Floats, weight: float) -> Solution:
        weighted = edge_weighted(self.operator, values, heat_time(GUIDE_WIDTH))
        return primal_dual(rof(self.operator.mass, values, self._mu(weight)), weighted, tolerance=self.tolerance)

    def _generalised(self, values: Floats, weight: float) -> Solution:
        problem = self._general.with_fidelity(rof(self.operator.mass, values, self._mu(weight)))
        return generalised_splitting(problem, tolerance=self.generalised_tolerance).solution

    @cached_property
    def _general(self) -> GeneralisedVariation:
        blank = rof(self.operator.mass, np.zeros(self.operator.vertex_count), 1.0)
        return GeneralisedVariation(blank, self.operator, RATIO * self.operator.edge_length)


def heat_time(width: float) -> float:
    """Return the time after which heat flow is as wide as a Gaussian of a full width at half maximum: width^2 / (16 ln 2)."""
    return width**2 / (16.0 * float(np.log(2.0)))
