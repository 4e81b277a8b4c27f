"""The fidelity of multi-phase segmentation: a linear cost over the probability simplex at each vertex."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats
from surfexp.variational.separable_quadratic import LEAST_SPREAD


@dataclass(frozen=True, eq=False)
class SimplexLabelling:
    """H(u) = sum_i m_i <u_i, r_i> with u_i >= 0, sum_j u_ij = 1.

    Parameters
    ----------
    mass : (n,) float64
    costs : (n, k) float64
        r, the cost of each label at each vertex.
    trivial_energy : float
        Energy of a labelling that needs no optimisation; those with one label everywhere are always considered.
    """

    mass: Floats
    costs: Floats
    trivial_energy: float = np.inf
    name: str = "multi-phase segmentation"

    @property
    def shape(self) -> tuple[int, ...]:
        """(n, k)."""
        return self.costs.shape

    @property
    def strong_convexity(self) -> float:
        """0."""
        return 0.0

    @property
    def step(self) -> float:
        """0.05 over the mean spread of the costs at a vertex."""
        return float(0.05 / max((self.costs.max(axis=1) - self.costs.min(axis=1)).mean(), 1e-300))

    def value(self, values: Floats) -> float:
        """H(u), infinite off the simplex (by more than 1e-9)."""
        if values.min() < -1e-9 or np.abs(values.sum(axis=1) - 1.0).max() > 1e-9:
            return float(np.inf)
        return float(self.mass @ (values * self.costs).sum(axis=1))

    def prox(self, values: Floats, step: float) -> Floats:
        """The projection of v - step r to the simplex."""
        return project_to_simplex(values - step * self.costs)

    def dual_value(self, load: Floats) -> float:
        """D(d) = sum_i min_j (d_ij + m_i r_ij)."""
        return float((load + self.mass[:, None] * self.costs).min(axis=1).sum())

    def primal_from_dual(self, load: Floats) -> Floats | None:
        """None: a vertex of the simplex, not unique."""
        return None

    def initial(self) -> Floats:
        """The same share of each label."""
        return np.full(self.shape, 1.0 / self.shape[1])

    @property
    def tolerance(self) -> float:
        """1e-2 of what the best labelling by one class leaves to gain."""
        return 1e-2

    def gap_scale(self, energy: float, lower_bound: float) -> float:
        """The spread from the best trivial labelling to the lower bound, not less than 1e-4 of the spread of the costs."""
        return max(self.trivial - lower_bound, self._least_spread, float(np.finfo(float).tiny))

    @cached_property
    def trivial(self) -> float:
        """Energy of the best labelling that needs no optimisation."""
        return min(self.trivial_energy, float((self.mass @ self.costs).min()))

    @cached_property
    def _least_spread(self) -> float:
        return LEAST_SPREAD * float(self.mass @ (self.costs.max(axis=1) - self.costs.min(axis=1)))


def project_to_simplex(points: Floats) -> Floats:
    """Return the nearest points with entries >= 0 that add up to 1.

    Parameters
    ----------
    points : (n, k) float64

    References
    ----------
    Michelot: A finite algorithm for finding the projection of a point onto the canonical simplex (1986).
    """
    result = np.array(points, dtype=np.float64, order="C")
    _project(result)
    return result


@njit(cache=True, nogil=True)
def _project(points: Floats) -> None:
    count, labels = points.shape
    for i in range(count):
        active = labels
        shift = (points[i].sum() - 1.0) / active
        while True:
            total, kept = -1.0, 0
            for j in range(labels):
                if points[i, j] > shift:
                    total += points[i, j]
                    kept += 1
            if kept >= active or kept == 0:  # rounding can bring an entry back
                break
            active, shift = kept, total / kept
        for j in range(labels):
            points[i, j] = max(points[i, j] - shift, 0.0)
