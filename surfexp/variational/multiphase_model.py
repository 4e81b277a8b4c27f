"""Segmentation into several regions by a convex relaxation with a simplex at each vertex."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from surfexp.mesh.triangle_mesh import Floats, Integers
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.accuracy import dice
from surfexp.variational.fidelity import Method
from surfexp.variational.image import Image
from surfexp.variational.separable_quadratic import check_positive
from surfexp.variational.simplex_labelling import SimplexLabelling
from surfexp.variational.solution import Solution

SETTLED = 1e-4
AVERAGES = 10
STARTS = 20


@dataclass(frozen=True)
class MultiphaseSegmentation:
    """min over the simplex of TV(u)/sqrt 2 + mu int sum_j u_j |c_j - I|^2, and c_j the means of the regions.

    TV couples the labels by the Frobenius norm; a jump between two labels costs the length of the boundary. The energy
    and the bound reported are sqrt 2 times those of this formula.

    Parameters
    ----------
    regions : int
    length : float
        ell in units of h: mu D^2 = 1 / (ell h), D the range of the c_j over (regions - 1).
    updates : int
        Largest number of updates of the c_j.

    References
    ----------
    Lellmann, Kappes, Yuan, Becker, Schnoerr: Convex multi-class image labeling by simplex-constrained total variation (2009).
    """

    regions: int = 3
    length: float = 2.0
    updates: int = 10

    def run(self, image: Image, operator: SurfaceOperator, method: Method) -> Solution:
        """Return u, (n, k), and in `segmentation` the number of the largest label, ordered by the first channel of c.

        Raises
        ------
        ValueError
            If there are fewer than 2 regions, the length is not positive, or the image has fewer distinct values.
        """
        check_positive("length", self.length)
        channels = image.values.reshape(len(image.values), -1)
        distinct = len(np.unique(channels, axis=0))
        if not 2 <= self.regions <= distinct:
            raise ValueError(f"regions is {self.regions}, must lie in 2..{distinct}, the distinct values of the image")
        means = _initial_means(_averaged(channels, operator), operator.mass, self.regions)
        solution: Solution | None = None
        settled, iterations = False, 0
        for update in range(1, self.updates + 1):
            solution = method(self._fidelity(channels, means, operator), operator, solution)
            iterations += solution.iterations
            labels = solution.values.argmax(axis=1)
            new, notes = _means(channels, operator.mass, labels, means)
            settled = bool(np.abs(new - means).max() <= SETTLED * np.ptp(channels))
            if settled or update == self.updates:
                break
            means = new
        assert solution is not None
        scores = {
            f"dice {name}": max(dice(operator.mass, labels == j, truth) for j in range(self.regions))
            for name, truth in image.labels.items()
        }
        least = {"least_dice": min(scores.values())} if scores else {}
        return replace(
            solution,
            segmentation=labels.astype(np.float64),
            iterations=iterations,
            converged=solution.converged and settled,
            reason=solution.reason if settled else f"the means still change after {update} updates",
            metrics=solution.metrics
            | {"updates": float(update), "iterations": float(iterations)}
            | {f"c{j + 1}": float(c[0]) for j, c in enumerate(means)}
            | scores
            | least,
            notes=(*solution.notes, *notes),
        )

    def _fidelity(self, channels: Floats, means: Floats, operator: SurfaceOperator) -> SimplexLabelling:
        distances = _squared_distances(channels, means)
        spread = float(np.linalg.norm(np.ptp(means, axis=0))) / (self.regions - 1)
        return SimplexLabelling(
            operator.mass, np.sqrt(2.0) * distances / (spread**2 * self.length * operator.edge_length)
        )


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
