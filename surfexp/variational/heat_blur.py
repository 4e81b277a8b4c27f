"""The fidelity mu/2 |K phi - I|^2 of deblurring, (2.7), K an implicit step of heat diffusion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array, diags_array

from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import LDLT, ldlt
from surfexp.operators.assembly import stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.separable_quadratic import check_positive


@dataclass(frozen=True, eq=False)
class HeatBlur:
    """H(phi) = mu/2 |K phi - I|_m^2 with K = T^-1 M, T = M + time Q, self-adjoint in the lumped mass.

    K is invertible, but so badly that its strong convexity is of no use. The dual problem has a second variable q, which is
    mu (K phi - I) at the optimum; stationarity, d + M K q = 0, gives it from the first: m q = -T M^-1 d.

    Parameters
    ----------
    operator : SurfaceOperator
    image : (n,) float64
        The blurred image I.
    mu : float
    time : float
        Diffusion time, in squared units of length; the blur has standard deviation sqrt(2 time).
    """

    operator: SurfaceOperator
    image: Floats
    mu: float
    time: float
    name: str = "deblurring"

    def __post_init__(self) -> None:
        check_positive("mu", self.mu)
        check_positive("time", self.time)
        if self.image.shape != (self.operator.vertex_count,):
            raise ValueError(
                f"image has shape {self.image.shape}, the operator has {self.operator.vertex_count} vertices"
            )

    @property
    def shape(self) -> tuple[int, ...]:
        """(n,)."""
        return self.image.shape

    @property
    def strong_convexity(self) -> float:
        """0."""
        return 0.0

    @property
    def step(self) -> float:
        """1 / mu."""
        return 1.0 / self.mu

    def blur(self, values: Floats) -> Floats:
        """Return K phi."""
        return self._heat.solve(self.operator.mass * values)

    def value(self, values: Floats) -> float:
        """H(phi)."""
        return 0.5 * self.mu * float(self.operator.mass @ (self.blur(values) - self.image) ** 2)

    def prox(self, values: Floats, step: float) -> Floats:
        """(1 + step mu K^2)^-1 (v + step mu K I), by the sparse system T M^-1 T + step mu M."""
        weight = step * self.mu
        return self._system(weight).solve(self._normal @ values + weight * (self._matrix @ self.image))

    def dual_value(self, load: Floats) -> float:
        """D(d) = <I, d'> - |d'|^2 / (2 mu m) with d' = T M^-1 d."""
        force = self._matrix @ (load / self.operator.mass)
        return float(self.image @ force - force @ (force / self.operator.mass) / (2.0 * self.mu))

    def primal_from_dual(self, load: Floats) -> Floats | None:
        """None: it would sharpen the errors of the dual field."""
        return None

    def initial(self) -> Floats:
        """The blurred image."""
        return self.image

    @property
    def tolerance(self) -> float:
        """1e-4 of the energy."""
        return 1e-4

    def gap_scale(self, energy: float, lower_bound: float) -> float:
        """The energy, not less than 1e-12 of that of the constant with the mean of the image."""
        mass = self.operator.mass
        mean = float(mass @ self.image / mass.sum())
        floor = 0.5e-12 * self.mu * float(mass @ (self.image - mean) ** 2)
        return max(energy, floor, float(np.finfo(float).tiny))

    @cached_property
    def _matrix(self) -> csr_array:
        return csr_array(diags_array(self.operator.mass) + self.time * stiffness(self.operator))

    @cached_property
    def _normal(self) -> csr_array:
        return csr_array(self._matrix @ diags_array(1.0 / self.operator.mass) @ self._matrix)

    @cached_property
    def _heat(self) -> LDLT:
        return ldlt(self._matrix)

    @cached_property
    def _systems(self) -> dict[float, LDLT]:
        return {}

    def _system(self, weight: float) -> LDLT:
        if weight not in self._systems:
            self._systems[weight] = ldlt(self._normal + weight * diags_array(self.operator.mass))
        return self._systems[weight]
