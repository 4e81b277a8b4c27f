"""Denoising by total generalised variation of second order: it keeps edges and avoids staircasing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.generalised_solution import GeneralisedSolution
from surfexp.variational.generalised_variation import GeneralisedVariation
from surfexp.variational.image import Image
from surfexp.variational.models.rof import noise_notes, weight_of, with_noise_level
from surfexp.variational.separable_quadratic import check_positive, rof
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import restoration_metrics

GeneralisedMethod = Callable[[GeneralisedVariation], GeneralisedSolution]


@dataclass(frozen=True)
class TGV:
    """min over u and w of sum over faces of A (|grad u - w| + ratio h |D w|), plus mu/2 |u - I|_m^2.

    w is linear on a face and grad u constant: |grad u - w| is taken of the mean of w on the face, at its middle.

    Parameters
    ----------
    weight : float
        Dimensionless weight, mu sigma h, as in `ROF`.
    mu : float, optional
        The weight itself, in 1 / (unit of the image * unit of length), in place of `weight`.
    ratio : float
        Length in edge lengths h over which a slope may turn: small ones blur, large ones give staircasing, as total variation
        does.
    """

    weight: float = 0.9
    mu: float | None = None
    ratio: float = 2.0

    def problem(self, image: Image, operator: SurfaceOperator) -> GeneralisedVariation:
        """Return the convex problem; the noise of a map that came without one is estimated (`noise_level`).

        Raises
        ------
        ValueError
            If a parameter is not positive, the image has several channels, or its noise is known to be 0.
        """
        check_positive("ratio", self.ratio)
        noisy = with_noise_level(image, operator) if self.mu is None else image
        data = rof(operator.mass, image.values, weight_of(self.weight, self.mu, noisy, operator))
        return GeneralisedVariation(data, operator, self.ratio * operator.edge_length)

    def run(self, image: Image, operator: SurfaceOperator, method: GeneralisedMethod) -> Solution:
        """Return the denoised image, with rmse and psnr where the clean one is known."""
        noisy = with_noise_level(image, operator) if self.mu is None else image
        solution = method(self.problem(noisy, operator)).solution
        metrics = solution.metrics | restoration_metrics(image, operator, solution.values)
        return replace(solution, metrics=metrics, notes=solution.notes + noise_notes(image, noisy))
