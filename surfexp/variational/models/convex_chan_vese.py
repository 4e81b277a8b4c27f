"""Two-phase segmentation by the convex Chan-Vese model, (2.19), with updated means."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import recertify
from surfexp.variational.fidelity import Method
from surfexp.variational.image import Image
from surfexp.variational.labellings import Labelling, Mask, best_threshold, edge_cut
from surfexp.variational.level_sets import perimeters
from surfexp.variational.mean_updates import SAME, MeanUpdates
from surfexp.variational.separable_quadratic import SeparableQuadratic, check_positive, convex_chan_vese
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import segmentation_metrics


@dataclass(frozen=True, eq=False)
class ConvexChanVese:
    """min over 0 <= phi <= 1 of TV(phi) + mu int phi ((c1 - I)^2 - (c2 - I)^2), and c1, c2 the means of the two regions.

    Region 1 is {phi > t}, the brighter one: c1 > c2.

    What is proved: for the c1, c2 of the last problem no field, hence no labelling of the vertices, has less energy than
    `lower_bound`. The relative gap is the share of the spread from the best trivial labelling (the empty field, the full
    one, or the best threshold of the image) down to that bound which the result has not gained: 0 is the minimum, 1 no
    better than without optimisation. Energies of fields and of labellings are of one functional, the piecewise linear total
    variation with lumped mass. Of t all are tried; the best labelling is above the bound by `labelling_gap` of the spread.
    What is not: the alternation with c1, c2, which may end in a local minimum.

    Parameters
    ----------
    smoothness : float
        Weight of the length, without unit: mu = 1 / (smoothness * W * var I), W the area of the surface over the length
        of the level line of the mean of the image, that is the mean width of what a plain threshold finds. Neither
        units nor size nor resolution enter. Below about 0.1 it is a threshold; the noise of single vertices makes W about
        an edge long and asks for 2 to 10.
    mu : float, optional
        The weight as published, in place of `smoothness`.
    initial : (n,) bool, optional
        One of the regions at the start; default: where the image exceeds its mean.
    updates : int
        Largest number of updates of c1 and c2.
    divide_by_area : bool
        False takes c1, c2 as published, integrals that are not divided by the area, which may oscillate for ever.
    """

    smoothness: float = 0.3
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
        values, cut = image.values, edge_cut(operator)
        means, notes = self.first_means(image, operator)
        updates = MeanUpdates(float(np.ptp(values)), self.updates)
        solution: Solution | None = None
        iterations = 0
        while updates.again(np.array(means)):
            fidelity, trivial = self.fidelity(image, operator, means)
            solution = method(fidelity, operator, solution)
            iterations += solution.iterations
            labelling = best_threshold(cut, operator.mass, fidelity.slope, solution.values, "phi")
            solved = means
            # as published, the region is {phi > 1/2} whatever energy it has
            region = labelling.region if self.divide_by_area else solution.values > 0.5
            means, notes = self.means(values, operator.mass, region, means)
        assert solution is not None  # noqa: S101, narrows a type
        solution = replace(solution, iterations=iterations, notes=(*solution.notes, *notes))
        solution, labelling = self._no_worse(solution, fidelity, labelling, trivial, operator)
        return self._result(updates.judge(solution), labelling, fidelity, solved, image, operator)

    def check(self, image: Image, operator: SurfaceOperator) -> None:
        """Raise ValueError if a parameter is not positive, or the image is constant or has several channels."""
        check_positive("smoothness", self.smoothness)
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

    def first_means(self, image: Image, operator: SurfaceOperator) -> tuple[tuple[float, float], tuple[str, ...]]:
        """Return c1 > c2 of the regions at the start, and what is to be said about them.

        Raises
        ------
        ValueError
            If both regions have the same mean.
        """
        values, mass = image.values, operator.mass
        region = self.first_region(image, operator)
        c1, c2 = _averages(values, mass, region)
        if c1 < c2:
            region = ~region
        if abs(c1 - c2) <= 1e-9 * float(np.ptp(values)):
            raise ValueError(f"both initial regions have the mean {c1:.6g}, it must differ: choose another initial")
        return self.means(values, mass, region, (float(values.max()), float(values.min())))

    def first_region(self, image: Image, operator: SurfaceOperator) -> Mask:
        """Return `initial`, or where the image exceeds its mean."""
        if self.initial is not None:
            return self.initial
        return image.values > operator.mass @ image.values / operator.mass.sum()

    def weight(self, image: Image, operator: SurfaceOperator) -> float:
        """Return mu, or 1 / (smoothness * W * var I) where it is None."""
        if self.mu is not None:
            return self.mu
        area = float(operator.mass.sum())
        mean = float(operator.mass @ image.values) / area
        variance = float(operator.mass @ (image.values - mean) ** 2) / area
        length = float(perimeters(operator, image.values, np.array([mean]))[0])
        return length / (self.smoothness * area * variance)

    def fidelity(
        self, image: Image, operator: SurfaceOperator, means: tuple[float, float]
    ) -> tuple[SeparableQuadratic, Labelling]:
        """Return the data term for given c1, c2, and the best trivial labelling, on which its relative gap is scaled."""
        c1, c2 = means
        slope = self.weight(image, operator) * ((c1 - image.values) ** 2 - (c2 - image.values) ** 2)
        trivial = best_threshold(edge_cut(operator), operator.mass, slope, image.values, "the image")
        return convex_chan_vese(operator.mass, slope, trivial.energy), trivial

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

    def _no_worse(
        self,
        solution: Solution,
        fidelity: SeparableQuadratic,
        labelling: Labelling,
        trivial: Labelling,
        operator: SurfaceOperator,
    ) -> tuple[Solution, Labelling]:
        """Return the field and the labelling of least energy among the solver's and the trivial ones, and say which."""
        best = trivial if trivial.energy < labelling.energy else labelling
        if solution.relative_gap is not None:
            solution = replace(solution, metrics=solution.metrics | {"solver_gap": solution.relative_gap})
        if best is trivial:
            said = f"The labelling is {best.name}, which has less energy than every level set of phi."
            solution = replace(solution, notes=(*solution.notes, said))
        if solution.dual is None or solution.energy <= best.energy:
            return solution, best
        said = (
            f"The energy of the solver's field, {solution.energy:.6g}, exceeds that of {best.name}, which is returned."
        )
        indicator = replace(solution, values=best.region.astype(np.float64), notes=(*solution.notes, said))
        return recertify(indicator, fidelity, operator), replace(best, threshold=0.5)

    def _result(
        self,
        solution: Solution,
        labelling: Labelling,
        fidelity: SeparableQuadratic,
        means: tuple[float, float],
        image: Image,
        operator: SurfaceOperator,
    ) -> Solution:
        assert fidelity.trivial_energy is not None  # noqa: S101, narrows a type
        mass, region = operator.mass, labelling.region
        metrics = {
            "c1": means[0],
            "c2": means[1],
            "iterations": float(solution.iterations),
            "brighter_share": float(mass @ region / mass.sum()),
            "trivial_energy": fidelity.trivial_energy,
            "labelling_energy": labelling.energy,
        }
        if solution.lower_bound is not None:
            scale = fidelity.gap_scale(labelling.energy, solution.lower_bound)
            metrics["labelling_gap"] = labelling_gap(labelling.energy, solution.lower_bound, scale)
        solution = replace(solution, segmentation=region.astype(np.float64))
        if ((solution.values > labelling.threshold) == region).all():
            metrics["threshold"] = labelling.threshold
        solution = replace(solution, metrics=solution.metrics | metrics)
        field, level = solution.boundary
        metrics["perimeter"] = float(perimeters(operator, field, np.array([level]))[0])
        return replace(solution, metrics=solution.metrics | metrics | segmentation_metrics(image, operator, region))


def labelling_gap(energy: float, lower_bound: float, scale: float) -> float:
    """Return (energy - lower bound) / scale, the scale of the relative gap: 0 where energy and bound are equal to rounding."""
    gap = energy - lower_bound
    return 0.0 if gap <= SAME * max(abs(energy), abs(lower_bound)) else gap / scale


def _averages(values: Floats, mass: Floats, region: Mask) -> tuple[float, float]:
    """Means of a region and its complement; an empty one has that of the whole."""
    whole = float(mass @ values / mass.sum())
    inside, outside = (
        float((mass * part) @ values / (mass @ part)) if part.any() else whole for part in (region, ~region)
    )
    return inside, outside
