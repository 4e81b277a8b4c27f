"""Two-phase segmentation by the convex Chan-Vese model, (2.19), with updated means."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from surfexp.mesh.triangle_mesh import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.accuracy import segmentation_metrics
from surfexp.variational.fidelity import Method
from surfexp.variational.image import Image
from surfexp.variational.level_sets import best_threshold, perimeters
from surfexp.variational.separable_quadratic import check_positive, convex_chan_vese
from surfexp.variational.solution import Solution

Mask = NDArray[np.bool_]
SETTLED = 1e-4


@dataclass(frozen=True, eq=False)
class ConvexChanVese:
    """min over 0 <= phi <= 1 of TV(phi) + mu int phi ((c1 - I)^2 - (c2 - I)^2), and c1, c2 the means of the two regions.

    Region 1 is {phi > t}. It starts as the brighter one, so a reference labelling should mark the bright side. The gap is that
    of the last convex problem, with its c1, c2; the alternation as a whole has no certificate.

    Parameters
    ----------
    length : float
        The length ell in units of the edge length h: mu (c1 - c2)^2 = 1 / (ell h). Details smaller than about ell h go.
    mu : float, optional
        The printed weight, in place of `length`.
    initial : (n,) bool, optional
        Region 1 at the start; default: where the image exceeds its mean.
    updates : int
        Largest number of updates of c1 and c2.
    divide_by_area : bool
        False takes c1, c2 as printed, integrals that are not divided by the area, which may oscillate for ever.
    """

    length: float = 2.0
    mu: float | None = None
    initial: Mask | None = None
    updates: int = 20
    divide_by_area: bool = True

    def run(self, image: Image, operator: SurfaceOperator, method: Method) -> Solution:
        """Return phi, and in `segmentation` its best level set.

        Raises
        ------
        ValueError
            If a parameter is not positive, the image is constant or has several channels.
        """
        self.check(image, operator)
        spread = float(np.ptp(image.values))
        region = self.first_region(image, operator) if self.initial is None else self.initial
        extremes = float(image.values.max()), float(image.values.min())
        means, notes = self.means(image.values, operator.mass, region, extremes)
        if abs(means[0] - means[1]) <= 1e-9 * spread:
            raise ValueError(
                f"both initial regions have the mean {means[0]:.6g}, it must differ: choose another initial"
            )
        solution: Solution | None = None
        settled, iterations = False, 0
        for update in range(1, self.updates + 1):
            slope = self._slope(image.values, means, operator)
            solution = method(convex_chan_vese(operator.mass, slope), operator, solution)
            iterations += solution.iterations
            new, notes = self.means(image.values, operator.mass, solution.values > 0.5, means)
            settled = max(abs(new[0] - means[0]), abs(new[1] - means[1])) <= SETTLED * spread
            if settled or abs(new[0] - new[1]) <= 1e-9 * spread or update == self.updates:
                break
            means = new
        assert solution is not None
        solution = replace(solution, iterations=iterations)
        return self._result(solution, slope, means, settled, update, notes, image, operator)

    def check(self, image: Image, operator: SurfaceOperator) -> None:
        """Raise ValueError if a parameter is not positive, or the image is constant or has several channels."""
        check_positive("length", self.length)
        if self.mu is not None:
            check_positive("mu", self.mu)
        if self.updates < 1:
            raise ValueError(f"updates is {self.updates}, must be at least 1")
        if image.values.shape != (operator.vertex_count,):
            raise ValueError(
                f"image {image.name!r} has shape {image.values.shape}, "
                f"convex Chan-Vese needs one value at each of the {operator.vertex_count} vertices"
            )
        if self.initial is not None and len(self.initial) != operator.vertex_count:
            raise ValueError(
                f"initial has {len(self.initial)} entries, the surface has {operator.vertex_count} vertices"
            )
        if np.ptp(image.values) == 0:
            raise ValueError(f"image {image.name!r} is constant at {image.values[0]}, two regions need two values")

    def first_region(self, image: Image, operator: SurfaceOperator) -> Mask:
        """Return where the image exceeds its mean."""
        return image.values > operator.mass @ image.values / operator.mass.sum()

    def weight(self, means: tuple[float, float], operator: SurfaceOperator) -> float:
        """Return mu, or 1 / (ell h (c1 - c2)^2) where it is None."""
        if self.mu is not None:
            return self.mu
        return 1.0 / (self.length * operator.edge_length * (means[0] - means[1]) ** 2)

    def means(
        self, values: Floats, mass: Floats, region: Mask, last: tuple[float, float]
    ) -> tuple[tuple[float, float], tuple[str, ...]]:
        """Return c1, c2 of a region and its complement; an empty one keeps its last c."""
        means, notes = [], []
        for name, part, kept in (("c1", region, last[0]), ("c2", ~region, last[1])):
            area = float(mass @ part)
            if area == 0:
                means.append(kept)
                notes.append(f"The region of {name} is empty, {name} keeps its last value {kept:.6g}.")
            else:
                integral = float((mass * values) @ part)
                means.append(integral / area if self.divide_by_area else integral)
        return (means[0], means[1]), tuple(notes)

    def _slope(self, values: Floats, means: tuple[float, float], operator: SurfaceOperator) -> Floats:
        c1, c2 = means
        slope: Floats = self.weight(means, operator) * ((c1 - values) ** 2 - (c2 - values) ** 2)
        return slope

    def _result(
        self,
        solution: Solution,
        slope: Floats,
        means: tuple[float, float],
        settled: bool,
        updates: int,
        notes: tuple[str, ...],
        image: Image,
        operator: SurfaceOperator,
    ) -> Solution:
        threshold, energy = best_threshold(operator, solution.values, slope)
        region = solution.values > threshold
        metrics = {
            "c1": means[0],
            "c2": means[1],
            "updates": float(updates),
            "iterations": float(solution.iterations),
            "threshold": threshold,
            "threshold_energy": energy,
            "perimeter": float(perimeters(operator, solution.values, np.array([threshold]))[0]),
        }
        return replace(
            solution,
            segmentation=region.astype(np.float64),
            converged=solution.converged and settled,
            reason=solution.reason if settled else f"c1 and c2 still change after {updates} updates",
            metrics=solution.metrics | metrics | segmentation_metrics(image, operator, region),
            notes=(*solution.notes, *notes),
        )
