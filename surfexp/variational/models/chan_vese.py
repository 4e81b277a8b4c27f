"""Two-phase segmentation by the non-convex Chan-Vese model with a regularised Heaviside function, (2.9)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import gradient
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Method, Progress
from surfexp.variational.image import Image
from surfexp.variational.labellings import Mask
from surfexp.variational.level_sets import perimeters
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.separable_quadratic import check_positive
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.face_sweeps import smoothed_normals
from surfexp.variational.truth_metrics import segmentation_metrics

LARGEST_MOVE = 1.0


@dataclass(frozen=True, eq=False)
class ChanVese:
    """min TV(H(phi)) + mu int (c1 - I)^2 H(phi) + mu int (c2 - I)^2 (1 - H(phi)), H = 1/2 + atan(phi)/pi.

    c1 and c2 are the means weighted by H(phi) and 1 - H(phi), for which the energy is least. Descends by explicit steps whose
    length is halved until the energy falls; stops at a local minimum, which depends on the initial curve. No certificate
    exists.

    Parameters
    ----------
    smoothness, mu, initial
        As in `ConvexChanVese`. {phi > 0} is the brighter region at the end too: c1 >= c2.
    height : float
        phi starts as +height and -height. A small one lets c1 and c2 start near each other, a large one freezes the curve,
        as the descent is scaled by the derivative of H.
    iteration_limit : int
    tolerance : float
        Bound of the relative fall of the energy over ten iterations.
    rest : int
        Steps without a change of {phi > 0} after which the curve counts as at rest; phi itself grows for ever.
    """

    smoothness: float = 0.3
    mu: float | None = None
    initial: Mask | None = None
    height: float = 3.0
    iteration_limit: int = 10000
    tolerance: float = 1e-6
    rest: int = 500

    def run(
        self,
        image: Image,
        operator: SurfaceOperator,
        method: Method | None = None,
        progress: Progress | None = None,
    ) -> Solution:
        """Return phi, with {phi > 0} in `segmentation`.

        The descent is the model's own and `method` is not used; `progress` is given the relative fall of the energy.
        """
        model = ConvexChanVese(self.smoothness, self.mu, self.initial)
        model.check(image, operator)
        check_positive("height", self.height)
        phi = np.where(model.first_region(image, operator), self.height, -self.height)
        descent = _Descent(operator, image.values, model.weight(image, operator))
        means = descent.means(phi)
        energies = [descent.energy(phi, means)]
        step, reason, moved = np.inf, "iteration limit", 0
        for iteration in range(1, self.iteration_limit + 1):
            before = phi > 0
            phi, step = descent.step(phi, means, energies[-1], step)
            moved = moved if np.array_equal(before, phi > 0) else iteration
            means = descent.means(phi)
            energies.append(descent.energy(phi, means))
            fall = (energies[max(0, iteration - 10)] - energies[-1]) / max(abs(energies[-1]), np.finfo(float).tiny)
            if progress is not None:
                progress(iteration, fall)
            if iteration >= 10 and fall <= self.tolerance:
                reason = "energy no longer falls"
                break
            if iteration - moved >= self.rest:
                reason = f"no vertex changed its side in {self.rest} steps"
                break
        if means[0] < means[1]:
            phi, means = -phi, means[::-1]
        region = phi > 0
        metrics = {"energy": energies[-1], "iterations": float(iteration), "c1": means[0], "c2": means[1]}
        metrics |= {"threshold": 0.0, "brighter_share": float(operator.mass @ region / operator.mass.sum())}
        metrics["perimeter"] = float(perimeters(operator, phi, np.array([0.0]))[0])
        return Solution(
            values=phi,
            energy=energies[-1],
            iterations=iteration,
            converged=reason != "iteration limit",
            reason=reason,
            history={"iteration": np.arange(len(energies), dtype=np.float64), "energy": np.array(energies)},
            model="Chan-Vese",
            solver="gradient descent",
            segmentation=region.astype(np.float64),
            metrics=metrics | segmentation_metrics(image, operator, region),
            notes=(*_empty(region), "The energy is not convex: a local minimum, without certificate."),
        )


def _empty(region: Mask) -> tuple[str, ...]:
    return () if region.any() and not region.all() else (f"phi > 0 at {region.sum()} of {len(region)} vertices.",)


def _heaviside(phi: Floats) -> Floats:
    inside: Floats = 0.5 + np.arctan(phi) / np.pi
    return inside


class _Descent:
    """Energy, means and descent steps for fixed mu."""

    def __init__(self, operator: SurfaceOperator, values: Floats, mu: float):
        self._operator, self._values, self._mu = operator, values, mu
        self._smoothing = 1e-3 / operator.edge_length
        self._dual = np.zeros((len(operator.faces), 1, 2))
        self._load = np.zeros((operator.vertex_count, 1))

    def means(self, phi: Floats) -> tuple[float, float]:
        """Return the c1 and c2 that minimise the energy of phi; both weights are positive."""
        inside = self._operator.mass * _heaviside(phi)
        outside = self._operator.mass - inside
        return float(inside @ self._values / inside.sum()), float(outside @ self._values / outside.sum())

    def energy(self, phi: Floats, means: tuple[float, float]) -> float:
        inside = _heaviside(phi)
        c1, c2 = ((c - self._values) ** 2 for c in means)
        lengths = np.sqrt((gradient(self._operator, inside) ** 2).sum(axis=1) + self._smoothing**2)
        data = self._mu * float(self._operator.mass @ (c1 * inside + c2 * (1.0 - inside)))
        return float(self._operator.areas @ (lengths - self._smoothing)) + data

    def step(self, phi: Floats, means: tuple[float, float], energy: float, step: float) -> tuple[Floats, float]:
        """Return the next phi, and twice the step that was short enough; the same phi if none of forty was.

        No value moves by more than 1: a longer step may lower the energy too, but freezes phi far from the curve's rest.
        """
        operator = self._operator
        inside = _heaviside(phi)
        smoothed_normals(
            *(operator.faces, operator.hat_gradients, operator.areas, self._smoothing),
            *(inside[:, None], self._dual, self._load),
        )
        c1, c2 = ((c - self._values) ** 2 for c in means)
        slope = (self._load[:, 0] / operator.mass + self._mu * (c1 - c2)) / (np.pi * (1.0 + phi**2))
        step = min(step, LARGEST_MOVE / float(np.abs(slope).max()))
        for _ in range(40):
            trial = phi - step * slope
            if self.energy(trial, means) < energy:
                return trial, 2.0 * step
            step *= 0.5
        return phi, step
