"""Total variation inpainting, (2.8)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Method
from surfexp.variational.image import Image
from surfexp.variational.models.rof import weight_of
from surfexp.variational.separable_quadratic import SeparableQuadratic, inpainting
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import restoration_metrics


@dataclass(frozen=True)
class Inpainting:
    """min TV(phi) + mu/2 int over the known part of (phi - I)^2, with min I <= phi <= max I.

    The box is part of the model: without it the dual bound is -infinity, and on obtuse faces it can change the minimiser.

    Parameters
    ----------
    weight : float
        mu sigma h, as in `ROF`.
    mu : float, optional
        The published weight, in place of `weight`; needed where the image has no noise.
    """

    weight: float = 0.9
    mu: float | None = None

    def fidelity(self, image: Image, operator: SurfaceOperator) -> SeparableQuadratic:
        """Return the data term.

        Raises
        ------
        ValueError
            If the image does not say which vertices are known, none is, or a weight is not positive.
        """
        if image.known is None:
            raise ValueError(f"image {image.name!r} does not say which vertices are known, inpainting needs a hole")
        mu = weight_of(self.weight, self.mu, image, operator)
        return inpainting(operator.mass, image.values, image.known, mu)

    def run(self, image: Image, operator: SurfaceOperator, method: Method) -> Solution:
        """Return the completed image, with rmse and psnr where the clean one is known."""
        solution = method(self.fidelity(image, operator), operator)
        return replace(solution, metrics=solution.metrics | restoration_metrics(image, operator, solution.values))
