"""Segmentation into several regions by a convex relaxation with a simplex at each vertex."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.calculus import total_variation
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Method
from surfexp.variational.image import Image
from surfexp.variational.mean_updates import MeanUpdates
from surfexp.variational.separable_quadratic import check_positive
from surfexp.variational.simplex_labelling import SimplexLabelling
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import dice

AVERAGES = 10
STARTS = 20


@dataclass(frozen=True)
class MultiphaseSegmentation:
    """min over the simplex of TV(u)/sqrt 2 + mu int sum_j u_j |c_j - I|^2, and c_j the means of the regions.

    TV couples the labels by the Frobenius norm; a jump between two labels costs the length of the boundary. The energy
    and the bound reported are sqrt 2 times those of this formula. The gap is that of the last convex problem, over the
    spread from the best trivial labelling (one region, or each vertex in the region of the nearest mean) down to the bound;
    the alternation with the means has no certificate.

    Parameters
    ----------
    regions : int
    smoothness : float
        Weight of the length, without unit: mu = 1 / (smoothness * W * var I), W the area of the surface over the length of
        the boundaries between the vertices of nearest first means; compare `ConvexChanVese`.
    mu : float, optional
        The weight itself, in place of `smoothness`.
    updates : int
        Largest number of updates of the c_j.

    References
    ----------
    Lellmann, Kappes, Yuan, Becker, Schnoerr: Convex multi-class image labeling by simplex-constrained total variation (2009).
    """

    regions: int = 3
    smoothness: float = 0.3
    mu: float | None = None
    updates: int = 10

    def run(self, image: Image, operator: SurfaceOperator, method: Method) -> Solution:
        """Return u, (n, k), and in `segmentation` the number of the region, ordered by the first channel of its mean.

        Raises
        ------
        ValueError
            If there are fewer than 2 regions, a weight is not positive, or the image has fewer distinct values.
        """
        channels = image.values.reshape(len(image.values), -1)
        self._check(channels)
        means = _initial_means(_averaged(channels, operator), operator.mass, self.regions)
        notes: tuple[str, ...] = ()
        mu = self._weight(channels, means, operator)
        updates = MeanUpdates(float(np.ptp(channels)), self.updates)
        solution: Solution | None = None
        iterations = 0
        while updates.again(means):
            distances = _squared_distances(channels, means)
            nearest = distances.argmin(axis=1)
            costs = np.sqrt(2.0) * mu * distances
            fidelity = SimplexLabelling(operator.mass, costs, _energy(nearest, costs, operator))
            solution = method(fidelity, operator, solution)
            iterations += solution.iterations
            labels = _least(operator, costs, solution.values.argmax(axis=1), nearest)
            solved = means
            means, notes = _means(channels, operator.mass, labels, means)
        assert solution is not None  # noqa: S101, narrows a type
        solution = updates.judge(replace(solution, iterations=iterations, notes=(*solution.notes, *notes)))
        energies = {"trivial_energy": fidelity.trivial, "labelling_energy": _energy(labels, costs, operator)}
        return self._result(solution, labels, solved, energies, image, operator)

    def _check(self, channels: Floats) -> None:
        check_positive("smoothness", self.smoothness)
        if self.mu is not None:
            check_positive("mu", self.mu)
        if self.updates < 1:
            raise ValueError(f"updates is {self.updates}, must be at least 1")
        distinct = len(np.unique(channels, axis=0))
        if not 2 <= self.regions <= distinct:
            raise ValueError(f"regions is {self.regions}, must lie in 2..{distinct}, the distinct values of the image")

    def _weight(self, channels: Floats, means: Floats, operator: SurfaceOperator) -> float:
        if self.mu is not None:
            return self.mu
        area = float(operator.mass.sum())
        variance = (
            float(operator.mass @ _squared_distances(channels, operator.mass[None] @ channels / area)[:, 0]) / area
        )
        labels = _squared_distances(channels, means).argmin(axis=1)
        length = _energy(labels, np.zeros((len(labels), self.regions)), operator) / np.sqrt(2.0)
        return length / (self.smoothness * area * variance)

    def _result(
        self,
        solution: Solution,
        labels: Integers,
        means: Floats,
        energies: dict[str, float],
        image: Image,
        operator: SurfaceOperator,
    ) -> Solution:
        order = np.argsort(means[:, 0], kind="stable")
        number = np.argsort(order, kind="stable")[labels]
        scores = {
            f"dice {name}": max(dice(operator.mass, number == j, truth) for j in range(self.regions))
            for name, truth in image.labels.items()
        }
        metrics = {"iterations": float(solution.iterations)} | energies
        metrics |= {f"c{j + 1}": float(c[0]) for j, c in enumerate(means[order])}
        metrics |= scores | ({"least_dice": min(scores.values())} if scores else {})
        dual = solution.dual
        return replace(
            solution,
            values=solution.values[:, order],
            dual=None if dual is None else dual[:, order],
            segmentation=number.astype(np.float64),
            metrics=solution.metrics | metrics,
        )


def _energy(labels: Integers, costs: Floats, operator: SurfaceOperator) -> float:
    """Energy of the field that is 1 in the column of its label."""
    indicator = np.eye(costs.shape[1])[labels]
    return total_variation(operator, indicator) + float(operator.mass @ costs[np.arange(len(labels)), labels])


def _least(operator: SurfaceOperator, costs: Floats, *candidates: Integers) -> Integers:
    """The labelling of least energy among the candidates and those with one label everywhere."""
    single = np.full(len(costs), int((operator.mass @ costs).argmin()))
    return min((*candidates, single), key=lambda labels: _energy(labels, costs, operator))


def _averaged(channels: Floats, operator: SurfaceOperator) -> Floats:
    """Return the image after some local averages, so that the first means are not those of single noisy vertices."""
    weights = mass_matrix(operator)
    for _ in range(AVERAGES):
        channels = weights @ channels / operator.mass[:, None]
    return channels


def _initial_means(channels: Floats, mass: Floats, regions: int) -> Floats:
    """Means of least squared distance from ten steps of Lloyd after each of twenty starts, by the first channel.

    A start draws its means one by one among the vertices, with the squared distance from those before as weight (Arthur,
    Vassilvitskii 2007).
    """
    random, best, least = np.random.default_rng(0), channels[:1], np.inf
    for _ in range(STARTS):
        means = channels[random.choice(len(channels), 1, p=mass / mass.sum())]
        while len(means) < regions:
            weights = mass * (_squared_distances(channels, means).min(axis=1) + np.finfo(float).tiny)
            means = np.vstack([means, channels[random.choice(len(channels), 1, p=weights / weights.sum())]])
        for _ in range(10):
            means, _ = _means(channels, mass, _squared_distances(channels, means).argmin(axis=1), means)
        misfit = float(mass @ _squared_distances(channels, means).min(axis=1))
        if misfit < least:
            best, least = means, misfit
    return best[np.argsort(best[:, 0], kind="stable")]


def _squared_distances(channels: Floats, means: Floats) -> Floats:
    distances: Floats = ((channels[:, None, :] - means) ** 2).sum(axis=2)
    return distances


def _means(channels: Floats, mass: Floats, labels: Integers, last: Floats) -> tuple[Floats, tuple[str, ...]]:
    means, notes = last.copy(), []
    for j in range(len(last)):
        part = labels == j
        if part.any():
            means[j] = mass[part] @ channels[part] / mass[part].sum()
        else:
            notes.append(f"Region {j + 1} is empty and keeps its last mean.")
    return means, tuple(notes)
