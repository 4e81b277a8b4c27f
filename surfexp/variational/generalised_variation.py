"""Total generalised variation of second order: a field and the slope it has for nothing, energy and certificate."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats
from surfexp.operators.crouzeix_raviart import TangentFields
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Certificate, certificate_of
from surfexp.variational.generalised_forms import GeneralisedForms
from surfexp.variational.separable_quadratic import SeparableQuadratic, check_positive

BALANCE = 1e-9
LEAST_SHARE = 1e-8
PARTS = (2, 4)


@dataclass(frozen=True, eq=False)
class GeneralisedVariation:
    """min over u and w of sum_T A_T ( |G u - w| + ratio |D w| ) + H(u), w a tangent field of Crouzeix and Raviart.

    What w takes over costs only its own variation: a linear function on a plane costs nothing, while a jump costs
    what it costs in total variation. D is the whole covariant derivative, not its symmetric part: only parallel fields
    cost nothing.

    Parameters
    ----------
    fidelity : SeparableQuadratic
        Quadratic, strongly convex, of one channel.
    operator : SurfaceOperator
        Consistent.
    ratio : float
        Unit of length: slopes that turn by their own size over this length cost as much as they spare.

    Raises
    ------
    ValueError
        If the ratio is not positive, the fidelity of another kind, or the operator has no gradients of its own faces.

    References
    ----------
    Bredies, Kunisch, Pock: Total generalized variation (2010).
    Baumgaertner, Bergmann, Herzog, Schmidt, Vidal-Nunez: Total generalized variation for piecewise constant functions
    on triangular meshes with applications in imaging (2023), for meshes and piecewise constant functions.
    """

    fidelity: SeparableQuadratic
    operator: SurfaceOperator
    ratio: float

    def __post_init__(self) -> None:
        check_positive("ratio", self.ratio)
        fidelity, count = self.fidelity, self.operator.vertex_count
        if not fidelity.is_quadratic or fidelity.strong_convexity <= 0 or fidelity.shape != (count,):
            raise ValueError(
                f"total generalised variation takes a strongly convex quadratic of {count} values, not {fidelity.name} "
                f"of shape {fidelity.shape}: denoise channels one by one"
            )
        if not self.operator.consistent or self.operator.averaged_gradient is not None:
            raise ValueError(
                f"operator {self.operator.name!r} has no gradient on faces of which the divergence is the adjoint: "
                "choose operator fem"
            )

    @cached_property
    def assembled(self) -> GeneralisedForms:
        """The matrices."""
        return GeneralisedForms(self.operator, self.ratio)

    @property
    def fields(self) -> TangentFields:
        """The space of w."""
        return self.assembled.fields

    @property
    def forms(self) -> csr_array:
        """(6 m, n + 2 e) matrix of u and w in one array: on each face two rows of G u - w, then four of ratio D w."""
        return self.assembled.forms

    @property
    def adjoint(self) -> csr_array:
        """(n + 2 e, 6 m) matrix of the load of a field, the adjoint of `forms` by area."""
        return self.assembled.adjoint

    def with_fidelity(self, fidelity: SeparableQuadratic) -> GeneralisedVariation:
        """Return the problem of another image or weight on the same mesh, which shares what was assembled."""
        other = replace(self, fidelity=fidelity)
        other.__dict__["assembled"] = self.assembled
        return other

    def energy(self, unknowns: Floats) -> float:
        """Energy of u and w: not less than that of u with its best w."""
        first, second = lengths(self.forms @ unknowns)
        return float(self.operator.areas @ (first + second)) + self.fidelity.value(self.values(unknowns))

    def values(self, unknowns: Floats) -> Floats:
        """Return u."""
        return unknowns[: self.operator.vertex_count]

    def feasible(self, dual: Floats) -> Floats:
        """Return the nearest (6 m,) field whose two parts balance at every edge, shrunk to a length of at most 1."""
        if self.assembled.imbalance(dual) > 0.1 * BALANCE:
            dual = self.assembled.balanced(dual)
        return dual / max(1.0, *(part.max() for part in lengths(dual)))

    def certify(self, unknowns: Floats, dual: Floats) -> Certificate:
        """Return the certificate of u and w by a field; without a lower bound where it is too long or does not balance.

        The gap is relative to the energy, which counts as not less than 1e-8 of that of a constant, or than rounding.
        """
        energy, longest = self.energy(unknowns), max(part.max() for part in lengths(dual))
        feasible = self.assembled.imbalance(dual) <= BALANCE and longest <= 1.0 + BALANCE
        lower_bound = self.fidelity.dual_value(self.values(self.adjoint @ dual)) if feasible else -float(np.inf)
        return certificate_of(energy, lower_bound, max(energy, self._least_scale), self.fidelity.strong_convexity)

    @cached_property
    def _least_scale(self) -> float:
        """1e-8 of the energy of a constant, or 1e5 times that of rounding, which is all that linear images have."""
        operator, target = self.operator, self.fidelity.target
        constant = np.full(target.shape, operator.mass @ target / operator.mass.sum())
        steepest = operator.areas @ np.linalg.norm(operator.hat_gradients, axis=2).max(axis=1)
        rounding = np.finfo(float).eps * np.abs(target).max() * steepest
        return max(LEAST_SHARE * self.fidelity.value(constant), float(1e5 * rounding), float(np.finfo(float).tiny))


def lengths(field: Floats) -> tuple[Floats, Floats]:
    """Return the (m,) lengths of the two parts of a (6 m,) field."""
    rows = field.reshape(-1, 6)
    return np.linalg.norm(rows[:, :2], axis=1), np.linalg.norm(rows[:, 2:], axis=1)


def shortened(field: Floats, first: float, second: float) -> Floats:
    """Return a (6 m,) field whose parts are shorter by these lengths on each face, zero where they were no longer."""
    shares = [
        1.0 - np.minimum(length / np.maximum(part, length), 1.0)
        for part, length in zip(lengths(field), (first, second), strict=True)
    ]
    return (field.reshape(-1, 6) * np.repeat(np.stack(shares, axis=1), PARTS, axis=1)).ravel()


def cut(field: Floats) -> Floats:
    """Return a (6 m,) field whose parts are cut to length 1 on each face."""
    shares = 1.0 / np.maximum(np.stack(lengths(field), axis=1), 1.0)
    return (field.reshape(-1, 6) * np.repeat(shares, PARTS, axis=1)).ravel()
