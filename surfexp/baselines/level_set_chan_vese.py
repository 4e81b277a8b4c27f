"""Segmentation by a moving level set on the narrow band: the non-convex Chan-Vese model by gradient descent."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.baselines.level_set import LevelSet
from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.separable_quadratic import check_positive
from surfexp.variational.solution import Solution

CROSSING = 10.0


@dataclass(frozen=True, eq=False)
class LevelSetChanVese:
    """Descent of (2.9), TV(H(phi)) + mu int (c1 - I)^2 H(phi) + (c2 - I)^2 (1 - H(phi)), by explicit steps on the band.

    phi_t = delta(phi) [div(P grad phi / |P grad phi|_eps) - mu (c1 - I)^2 + mu (c2 - I)^2] with H(phi) = 1/2 +
    arctan(phi / w) / pi, delta = H', and c1, c2 the means of the two regions at each step (divided by their area). phi
    is the level-set function of the curve, positive inside.

    Parameters
    ----------
    level_set : LevelSet
        Band and stencils, regularisation (here a slope, without unit), tolerance and step limit; the unit of its
        extension interval is the time in which the data term alone would move the curve by ten widths.
    mu : float
        Weight, in 1 / (unit of the image^2 * unit of length).
    width : float
        w in grid steps.
    """

    level_set: LevelSet
    mu: float
    width: float = 1.5

    def __call__(self, image: Floats, operator: SurfaceOperator, initial: Floats) -> Solution:
        """Move the zero level of `initial`.

        Parameters
        ----------
        image : (n,) float64
        operator : SurfaceOperator
            Under which the energy of the result is measured.
        initial : (n,) float64
            Level-set function at the vertices, about the signed distance to the first curve.

        Returns
        -------
        Solution
            `values` is H(phi) at the vertices, `segmentation` where phi is positive. There is no certificate.

        Raises
        ------
        ValueError
            If mu or width is not positive.
        """
        check_positive("mu", self.mu)
        check_positive("width", self.width)
        scheme, energy = self.level_set, self.level_set.energy
        band, mass = energy.band, energy.mass
        data, phi = band.extend(image), band.extend(initial)
        width = self.width * band.step
        step = 1.8 * scheme.regularisation / energy.difference_bound * np.pi * width
        speed = self.mu * float(np.ptp(data)) ** 2 / (np.pi * width)
        interval = math.ceil(scheme.extension_interval * CROSSING * width / (speed * step))
        load = np.empty_like(phi)
        rows: list[tuple[float, float]] = []
        means = (float(data.max()), float(data.min()))
        converged = False
        for iteration in range(scheme.step_limit + 1):
            energy.projected_load(phi, scheme.regularisation, load)
            inside = 0.5 + np.arctan(phi / width) / np.pi
            means = _means(mass, phi > 0, data, means)
            slope = self.mu * ((means[0] - data) ** 2 - (means[1] - data) ** 2)
            if iteration % interval == 0 or iteration == scheme.step_limit:
                misfit = self.mu * mass @ (data - means[1]) ** 2
                rows.append(
                    (iteration, energy.total_variation(inside) + float(mass @ (slope * inside)) + float(misfit))
                )
                fall = rows[-2][1] - rows[-1][1] if iteration else np.inf
                converged = iteration % interval == 0 and abs(fall) <= scheme.tolerance * abs(rows[-1][1])
                if converged or iteration == scheme.step_limit:
                    break
            delta = width / (np.pi * (width**2 + phi**2))
            phi = phi - step * delta * (load / mass + slope)
            if (iteration + 1) % interval == 0:
                phi = scheme.to_closest(phi)
        return self._result(scheme.to_vertices(phi), width, means, rows, converged, image, operator)

    def _result(
        self,
        phi: Floats,
        width: float,
        means: tuple[float, float],
        rows: list[tuple[float, float]],
        converged: bool,
        image: Floats,
        operator: SurfaceOperator,
    ) -> Solution:
        values = 0.5 + np.arctan(phi / width) / np.pi
        misfit = (means[0] - image) ** 2 * values + (means[1] - image) ** 2 * (1.0 - values)
        surface_energy = total_variation(operator, values) + self.mu * float(operator.mass @ misfit)
        iterations, energies = (np.array(column, dtype=np.float64) for column in zip(*rows, strict=True))
        return Solution(
            values=values,
            energy=surface_energy,
            iterations=int(iterations[-1]),
            converged=converged,
            reason="energy stationary" if converged else "step limit",
            history={"iteration": iterations, "energy": energies},
            model="Chan-Vese",
            solver="level_set",
            segmentation=(phi > 0).astype(np.float64),
            metrics={
                "energy": surface_energy,
                "iterations": float(iterations[-1]),
                "c1": means[0],
                "c2": means[1],
                "node_count": float(self.level_set.energy.band.node_count),
                "memory_bytes": float(self.level_set.memory),
            },
            notes=("no certificate: the model is not convex, and it was solved on a grid around the surface",),
        )


def _means(mass: Floats, inside: NDArray[np.bool_], data: Floats, last: tuple[float, float]) -> tuple[float, float]:
    """c1 and c2, the last ones where a region is empty."""
    weights = (mass * inside, mass * ~inside)
    areas = [float(weight.sum()) for weight in weights]
    floor = 1e-9 * sum(areas)
    first, second = (
        float(w @ data) / a if a > floor else kept for w, a, kept in zip(weights, areas, last, strict=True)
    )
    return first, second
