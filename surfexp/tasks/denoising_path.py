"""Denoising a map for every weight at once, with a gap that is proved at all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.mesh.given_arrays import real_array
from surfexp.mesh.given_numbers import real_number, real_pair
from surfexp.smoothing.path_risk import PathRisk, path_risk
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.tasks.given_map import MapLike
from surfexp.tasks.given_surface import SurfaceLike
from surfexp.tasks.noisy_image import NoisyImage, noisy_image
from surfexp.tasks.risk_curve import AT_AN_END, HEAVY_TAILS, RiskCurve
from surfexp.variational.fitted_noise import FittedNoise
from surfexp.variational.rof_path import RofPath, rof_path

# weights at which the risk is estimated by default, for each factor of ten
PER_DECADE = 20
# tails are those of what a weight that is smoother than the best removes
OF_LEAST = 0.5

Progress = Callable[[int, float], None]


@dataclass(frozen=True, eq=False, repr=False)
class DenoisingPath(Drawable):
    """A map denoised by total variation, for every weight of a range.

    Parameters
    ----------
    weights : (k,) float64
        That were solved, growing; between them results are interpolated, with their gap.
    certificate : dict
        relative_gap (none at any weight of the range is larger), solves, noise.
    notes : tuple of str
    name : str
        Under which the surface carries the map that it was made of.
    _path : RofPath
        What `at` interpolates.
    _image : NoisyImage
        The map before, and where its values lie on the surface.
    """

    weights: Floats
    certificate: dict[str, Any]
    notes: tuple[str, ...] = ()
    name: str = "map"
    _path: RofPath | None = field(default=None, repr=False)
    _image: NoisyImage | None = field(default=None, repr=False)

    def at(self, weight: float) -> DenoisedMap:
        """Return the denoised map at a weight.

        Parameters
        ----------
        weight : float
            Between the first and the last of `weights`; dimensionless, as in `surfexp.denoise`.

        Returns
        -------
        DenoisedMap
            With its own relative_gap and error_bound, computed for this weight.

        Raises
        ------
        ValueError
            If the weight is outside of the range.
        """
        assert self._path is not None and self._image is not None  # noqa: S101, narrows a type
        solution = self._path.at(self._mu(weight))
        error = float((solution.error_bound or 0.0) / np.sqrt(self._path.operator.mass.sum()))
        facts = {"noise": self.certificate["noise"], "weight": weight}
        facts |= {"relative_gap": solution.relative_gap, "error_bound": error}
        values = self._image.on_whole(solution.values)
        return DenoisedMap(values, "rof", facts, self.notes, self.name, given=self.given)

    def risk(self, weights: ArrayLike | None = None) -> RiskCurve:
        """Estimate the risk at some weights, by Stein's unbiased estimate with one probe drawn from the fitted noise.

        The first call solves the map with the probe at each of `weights` again, which takes about as long as the path.

        Parameters
        ----------
        weights : (k,) float64, optional
            Between the first and the last of `weights`, growing; by default 20 for each factor of ten, evenly spaced in the
            logarithm.

        Returns
        -------
        RiskCurve
            `risks` and `errors` over the variance of the noise, `weight` where it is least.

        Raises
        ------
        ValueError
            If a weight is outside of the range, they do not grow, or the map has several channels.

        References
        ----------
        Stein: Estimation of the mean of a multivariate normal distribution (1981).
        """
        low, high = float(self.weights[0]), float(self.weights[-1])
        if weights is None:
            asked = np.geomspace(low, high, max(2, round(PER_DECADE * np.log10(high / low)) + 1))
            asked[0], asked[-1] = low, high
        else:
            asked = np.atleast_1d(real_array(weights, "weights"))
        if asked.ndim != 1 or not len(asked) or not (np.diff(asked) > 0.0).all():
            raise ValueError(f"weights = {np.array2string(asked, threshold=6)}, one row of numbers that grow is needed")
        known = self._known_risk
        found = np.array([known.at(self._mu(float(weight))) for weight in asked])
        curve = RiskCurve(asked, found[:, 0], found[:, 1])
        notes: tuple[str, ...] = (AT_AN_END.format(weight=curve.weight),) if curve.weight in (low, high) else ()
        notes += (HEAVY_TAILS,) if known.has_heavy_tails(self._mu(max(OF_LEAST * curve.weight, low))) else ()
        return replace(curve, notes=notes)

    @property
    def given(self) -> Floats:
        """(n,) or (n, c) the map before; NaN outside the mask."""
        assert self._image is not None  # noqa: S101, narrows a type
        return self._image.on_whole(self._image.values)

    def place(self, weight: float) -> float:
        """Return where between the solved weights the map at a weight is interpolated.

        Parameters
        ----------
        weight : float
            Between the first and the last of `weights`.

        Returns
        -------
        float
            2.25 is a quarter of the way from the map at the third of them to that at the fourth.

        Raises
        ------
        ValueError
            If the weight is outside of the range.
        """
        assert self._path is not None  # noqa: S101, narrows a type
        interval, share = self._path.place(self._mu(weight))
        return interval + share

    def view(self, surface: Any, **options: Any) -> Any:
        """Show the map at every weight on its surface, by a slider: the same as ``surfexp.view(surface, path, **options)``.

        Parameters
        ----------
        surface : Surface, path, or (vertices, faces)
            That of the map.
        **options
            Of `surfexp.view`: views, colormap, limits, label, unit, title.

        Returns
        -------
        TurningView
            `save(path)` writes .html, .png, .svg or .pdf.

        Raises
        ------
        ValueError
            If it is not the surface, or the map has several channels.
        """
        # by name: drawing stands above what is drawn
        return import_module("surfexp").view(surface, self, **options)

    @cached_property
    def _known_risk(self) -> PathRisk:
        assert self._path is not None and self._image is not None  # noqa: S101, narrows types
        if self._path.image.ndim > 1:
            raise ValueError(
                f"the risk is estimated of one channel, the map has {self._path.image.shape[1]}: give each by itself"
            )
        return path_risk(self._path, float(self.certificate["noise"]), known=self._image.known_noise)

    def _mu(self, weight: float) -> float:
        """The weight of the model in the unit of the map."""
        assert self._path is not None  # noqa: S101, narrows a type
        weight = real_number(weight, "weight", above=0.0)
        if not self.weights[0] <= weight <= self.weights[-1]:
            raise ValueError(
                f"weight = {weight:g} is outside of the path, choose one from {self.weights[0]:g} to {self.weights[-1]:g}"
            )
        mus = self._path.mus
        return float(np.clip(weight * float(mus[0] / self.weights[0]), mus[0], mus[-1]))

    def _summary(self) -> Summary:
        facts = {"weights": f"{self.weights[0]:g} to {self.weights[-1]:g}"}
        facts |= {name.replace("_", " "): value for name, value in self.certificate.items()}
        return Summary("a map denoised for every weight", facts, self.notes)


def denoise_path(
    surface: SurfaceLike,
    values: MapLike,
    *,
    weights: tuple[float, float] = (0.03, 30.0),
    noise: float | FittedNoise | None = None,
    tolerance: float = 1e-3,
    progress: Progress | None = None,
) -> DenoisingPath:
    """Remove noise from a map by total variation, for every weight of a range at once.

    The model is that of ``surfexp.denoise(method="rof")``. Some weights are solved; between two of them the results and their
    dual fields are interpolated. That pair proves a gap at every weight, and more weights are solved until none exceeds the
    tolerance.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        The map is denoised inside the mask, or where it is finite if there is no mask.
    values : str or (n,) or (n, c) float64
        Name of a map of the surface, or the map; NaN where nothing is known.
    weights : (float, float)
        The range, dimensionless; small is smooth. The default is a factor of 1,000 about 0.9, the weight of `denoise`.
    noise : float or FittedNoise, optional
        Standard deviation of the noise, in the unit of the map, or what `noise` has read, as from a second measurement;
        estimated from the map if not given.
    tolerance : float
        Largest relative duality gap at any weight of the range.
    progress : callable, optional
        Receives the number of solves so far and the largest gap that is left.

    Returns
    -------
    DenoisingPath
        `at(weight)` is the map at a weight, with its certificate.

    Raises
    ------
    ValueError
        If the map does not fit, is constant while its noise is not given, the range is empty, or a parameter is out of its range.

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=3)
    >>> noisy = sphere.mesh.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(642)
    >>> path = sx.denoise_path(sphere, noisy, tolerance=1e-2)
    >>> bool(path.at(0.5).certificate["relative_gap"] <= path.certificate["relative_gap"] <= 1e-2)
    True
    """
    low, high = (real_number(weight, "weights", above=0.0) for weight in real_pair(weights, "weights"))
    if not low < high:
        raise ValueError(f"weights = ({low:g}, {high:g}) is no range, give the smaller one first")
    tolerance = real_number(tolerance, "tolerance", above=1e-8, below=1.0)
    image = noisy_image(surface, values, noise)
    sigma, said = image.noise()
    scale = image.data_weight(1.0, sigma)
    path = rof_path(image.operator, image.values, low * scale, high * scale, tolerance=tolerance, progress=progress)
    solved = np.clip(path.mus / scale, low, high)
    solved[0], solved[-1] = low, high
    certificate = {"relative_gap": path.largest_gap, "solves": len(solved), "noise": sigma}
    return DenoisingPath(solved, certificate, image.part.notes + said, image.name, path, image)
