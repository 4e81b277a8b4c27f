"""Total variation denoising: the model of Rudin, Osher and Fatemi, (2.6)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Method
from surfexp.variational.image import Image
from surfexp.variational.models.channelwise import solve_by_channel
from surfexp.variational.noise_level import noise_level
from surfexp.variational.separable_quadratic import SeparableQuadratic, check_positive, rof
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import restoration_metrics


@dataclass(frozen=True)
class ROF:
    """min TV(phi) + mu/2 |phi - I|^2; several channels share the norm |D phi|_F of a face.

    Parameters
    ----------
    weight : float
        Weight without unit, mu sigma h with the noise sigma of the image and the edge length h; the error is least
        near 1, the residual is as large as the noise near 0.55.
    mu : float, optional
        The published weight, in 1 / (unit of the image * unit of length), in place of `weight`.
    by_channel : bool
        Denoise the channels one by one, as published, in place of the rotation-invariant |D phi|_F.
    """

    weight: float = 0.9
    mu: float | None = None
    by_channel: bool = False

    def fidelity(self, image: Image, operator: SurfaceOperator) -> SeparableQuadratic:
        """Return the data term; the noise of a map that came without one is estimated (`noise_level`).

        Raises
        ------
        ValueError
            If a weight is not positive, or `weight` is to be used for an image that is known to have no noise.
        """
        noisy = with_noise_level(image, operator) if self.mu is None else image
        return rof(operator.mass, image.values, weight_of(self.weight, self.mu, noisy, operator))

    def run(self, image: Image, operator: SurfaceOperator, method: Method) -> Solution:
        """Return the denoised image, with rmse and psnr where the clean one is known."""
        noisy = with_noise_level(image, operator) if self.mu is None else image
        fidelity = self.fidelity(noisy, operator)
        separate = self.by_channel and len(fidelity.shape) > 1
        solution = solve_by_channel(fidelity, operator, method) if separate else method(fidelity, operator)
        metrics = solution.metrics | restoration_metrics(image, operator, solution.values)
        return replace(solution, metrics=metrics, notes=solution.notes + noise_notes(image, noisy))


def with_noise_level(image: Image, operator: SurfaceOperator) -> Image:
    """Return an image with its noise estimated, where neither the noise nor the clean image is known; others as they are."""
    if image.noise > 0 or image.clean is not None:
        return image
    return replace(image, noise=noise_level(operator, image.values))


def noise_notes(image: Image, noisy: Image) -> tuple[str, ...]:
    """Say what `with_noise_level` has estimated, if it had to."""
    if noisy is image:
        return ()
    unit = f" {image.unit}" if image.unit else ""
    return (f"The noise of the map is not known: its standard deviation is estimated as {noisy.noise:.3g}{unit}.",)


def weight_of(weight: float, mu: float | None, image: Image, operator: SurfaceOperator) -> float:
    """Return mu, or weight / (sigma h) where it is None.

    Raises
    ------
    ValueError
        If a weight is not positive, or `weight` is to be used and the noise of the image is not known.
    """
    if mu is not None:
        check_positive("mu", mu)
        return mu
    check_positive("weight", weight)
    if image.noise <= 0:
        raise ValueError(
            f"image {image.name!r} has noise {image.noise}, weight = mu sigma h needs sigma > 0: give mu instead"
        )
    return weight / (image.noise * operator.edge_length)
