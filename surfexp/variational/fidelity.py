"""The convex data term H of min TV(phi) + H(phi), (2.5) and (2.10), and the types that solvers share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.solution import Solution

Progress = Callable[[int, float], None]


class Fidelity(Protocol):
    """A convex function H of the nodal values, known by its value and its proximal map.

    Every inner product is that of the lumped mass m. `load` is a covector d = G^T A p, one entry a value.
    """

    @property
    def name(self) -> str:
        """The model, for captions."""
        ...

    @property
    def shape(self) -> tuple[int, ...]:
        """(n,) or (n, c)."""
        ...

    @property
    def strong_convexity(self) -> float:
        """Largest mu for which H - mu/2 |.|_m^2 is convex; 0 if there is none."""
        ...

    @property
    def step(self) -> float:
        """A primal step tau of the right size for `prox`: (spread of the values) / (size of their multipliers)."""
        ...

    @property
    def tolerance(self) -> float:
        """A relative gap that is small on the model's own scale."""
        ...

    def value(self, values: Floats) -> float:
        """H(phi), infinite outside its domain."""
        ...

    def prox(self, values: Floats, step: float) -> Floats:
        """argmin_phi H(phi) + |phi - values|_m^2 / (2 step)."""
        ...

    def dual_value(self, load: Floats) -> float:
        """D(d) = inf_phi <d, phi> + H(phi), a lower bound of the energy; -inf when it is not known."""
        ...

    def primal_from_dual(self, load: Floats) -> Floats | None:
        """The phi that attains D(d), where it is unique; else None."""
        ...

    def initial(self) -> Floats:
        """A point of the domain to start from."""
        ...

    def gap_scale(self, energy: float, lower_bound: float) -> float:
        """The positive number by which the gap, energy - lower_bound, is divided to give the relative gap."""
        ...


class Method(Protocol):
    """A solver with its options filled in: minimises TV + H over one operator."""

    def __call__(self, fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None = None) -> Solution:
        """Return the minimiser; `start` is an earlier solution from which to go on."""
        ...
