"""Total variation deblurring, (2.7), of an image blurred by heat diffusion."""

from __future__ import annotations

from dataclasses import dataclass, replace

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Method
from surfexp.variational.heat_blur import HeatBlur
from surfexp.variational.image import Image
from surfexp.variational.models.rof import noise_notes, weight_of, with_noise_level
from surfexp.variational.separable_quadratic import check_positive
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import restoration_metrics


@dataclass(frozen=True)
class Deblurring:
    """min TV(phi) + mu/2 |K phi - I|^2, K an implicit step of heat diffusion.

    Parameters
    ----------
    width : float
        Standard deviation sqrt(2 time) of the blur in units of the edge length h.
    weight : float
        mu sigma h, as in `ROF`.
    mu : float, optional
        The published weight, in place of `weight`.
    """

    width: float = 2.0
    weight: float = 0.9
    mu: float | None = None

    def fidelity(self, image: Image, operator: SurfaceOperator) -> HeatBlur:
        """Return the data term; the noise of a map that came without one is estimated.

        Raises
        ------
        ValueError
            If a parameter is not positive or the image has several channels.
        """
        check_positive("width", self.width)
        noisy = with_noise_level(image, operator) if self.mu is None else image
        mu = weight_of(self.weight, self.mu, noisy, operator)
        return HeatBlur(operator, image.values, mu, 0.5 * (self.width * operator.edge_length) ** 2)

    def run(self, image: Image, operator: SurfaceOperator, method: Method) -> Solution:
        """Return the sharpened image, with rmse and psnr where the clean one is known."""
        noisy = with_noise_level(image, operator) if self.mu is None else image
        solution = method(self.fidelity(noisy, operator), operator)
        metrics = solution.metrics | restoration_metrics(image, operator, solution.values)
        return replace(solution, metrics=metrics, notes=solution.notes + noise_notes(image, noisy))
