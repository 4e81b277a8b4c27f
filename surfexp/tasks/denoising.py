"""Denoising and smoothing of maps on a surface."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.given_arrays import real_number
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.heat_polynomial import heat_polynomial, largest_eigenvalue_bound
from surfexp.tasks.automatic_denoising import automatically_denoised
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.tasks.inputs import MapLike, SurfaceLike, as_map, as_surface, name_of, part_for, plausible
from surfexp.variational.fidelity import Progress
from surfexp.variational.generalised_variation import GeneralisedVariation
from surfexp.variational.noise_level import noise_level
from surfexp.variational.separable_quadratic import SeparableQuadratic, rof
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.generalised_splitting import generalised_splitting
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.surface_flows import heat_flow

# where slivers make the polynomial of the heat kernel too long; 100 steps are 1 % narrower than the kernel
HEAT_STEPS, MOST_TERMS = 100, 3000.0
NEWTON_BELOW = 1e-6
# what varies less than this share of the largest value is rounding
ROUNDING = 1e-12
# its square is a time
WIDEST = 1e100


def denoise(
    surface: SurfaceLike,
    values: MapLike,
    *,
    method: Literal["rof", "tgv", "auto"] = "rof",
    weight: float = 0.9,
    ratio: float = 2.0,
    noise: float | None = None,
    tolerance: float = 1e-4,
    progress: Progress | None = None,
) -> DenoisedMap:
    """Remove noise from a map by total variation (Rudin, Osher and Fatemi), which keeps its edges.

    Minimises ``TV(u) + mu/2 |u - f|^2`` with ``mu = weight / (noise * h)``, h the side of the equilateral triangle of
    mean area, and proves how near the result is to the minimiser. Values outside the mask neither enter nor leave:
    the condition at its boundary is natural. Where a map has slopes as well as edges, "tgv" takes the total
    generalised variation of second order in its place, which makes no stairs. "auto" takes what promises the least
    error by Stein's estimate for independent noise: the heat kernel, TV, or TV that is cheap at edges.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        Its mask, or else the finite values of the map, is where the map is denoised.
    values : str or (n,) or (n, c) float64
        Name of a map of the surface, or the map; NaN where nothing is known.
    method : {"rof", "tgv", "auto"}
        "tgv" and "auto" take one channel.
    weight : float
        Of "rof" and "tgv", without unit; smaller is smoother. The error is least near 1.
    ratio : float
        Of "tgv": the length over which a slope may turn, in edge lengths h; large ones do as "rof".
    noise : float, optional
        Standard deviation of the noise, in the unit of the map; estimated from the map if not given.
    tolerance : float
        Largest relative duality gap; that of "auto" is 1e-3.
    progress : callable, optional
        Receives the iteration and the gap.

    Returns
    -------
    DenoisedMap
        `values`, and the certificate with noise, weight, relative_gap and error_bound (largest possible root-mean-square
        distance to the exact minimiser, in the unit of the map). Of "auto": chosen (the method), parameter (a full width at
        half maximum, or a weight), risk_METHOD (estimated mean square error over the variance of the noise).

    Raises
    ------
    ValueError
        If the map does not fit, is constant, or a parameter is not positive.

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=3)
    >>> noisy = sphere.mesh.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(642)
    >>> bool(sx.denoise(sphere, noisy).certificate["relative_gap"] <= 1e-4)
    True
    """
    weight = real_number(weight, "weight", above=0.0)
    ratio = real_number(ratio, "ratio", above=0.0)
    tolerance = real_number(tolerance, "tolerance", above=0.0, below=1.0)
    owner = as_surface(surface)
    noisy = as_map(owner, values)
    part = part_for(owner, noisy)
    operator, image = fem(part.mesh), plausible(np.asarray(part.restrict(noisy), dtype=np.float64))
    # neither a constant nor a unit changes what is solved, nor its gap
    centre, scale = _centre_and_scale(image, noise is None)
    image = (image - centre) / scale
    sigma = noise_level(operator, image) if noise is None else real_number(noise, "noise", above=0.0) / scale
    if method == "auto":
        found = automatically_denoised(owner, part, operator, image, sigma, noise is None)
        certificate = found.certificate | {"noise": sigma * scale}
        return replace(found, values=found.values * scale + centre, certificate=certificate, name=name_of(values))
    facts: dict[str, Any] = {"noise": sigma * scale, "noise_estimated": noise is None, "weight": weight}
    facts |= {"ratio": ratio} if method == "tgv" else {}
    solution = _minimised(method, _data(operator, image, sigma, weight), operator, ratio, tolerance, progress)
    notes = part.notes + solution.notes
    certificate = facts | _proof(solution, operator, scale)
    clean = part.extend(solution.values * scale + centre)
    return DenoisedMap(clean, method, certificate, notes, name_of(values))


def _centre_and_scale(image: Floats, noise_unknown: bool) -> tuple[Floats, float]:
    """Return the mean of each channel, and the size of what varies.

    Raises
    ------
    ValueError
        If the map is constant, to rounding, and its noise is to be estimated.
    """
    largest = float(np.abs(image).max())
    centre = (image / largest).mean(axis=0) * largest if largest > 0 else np.zeros(image.shape[1:])
    scale = float(np.abs(image - centre).max())
    if scale > ROUNDING * largest:
        return centre, scale
    if noise_unknown:
        raise ValueError(f"map is constant ({image.flat[0]:g}) to rounding: it has no noise to be estimated")
    return centre, 1.0


def _data(operator: SurfaceOperator, image: Floats, noise: float, weight: float) -> SeparableQuadratic:
    """The distance to the map, by its weight without unit."""
    if not (noise > 0 and weight > 0):
        raise ValueError(
            f"noise is {noise:g} and weight {weight:g}, both must be positive: a constant map has no noise"
        )
    return rof(operator.mass, image, weight / (noise * operator.edge_length))


def _minimised(
    method: str,
    data: SeparableQuadratic,
    operator: SurfaceOperator,
    ratio: float,
    tolerance: float,
    progress: Progress | None,
) -> Solution:
    """Solve the model that a method stands for, by the solver that suits the tolerance."""
    if method == "tgv":
        problem = GeneralisedVariation(data, operator, ratio * operator.edge_length)
        return generalised_splitting(problem, tolerance=tolerance, progress=progress).solution
    if method == "rof":
        solver = newton if tolerance < NEWTON_BELOW and len(data.shape) == 1 else primal_dual
        return solver(data, operator, tolerance=tolerance, progress=progress)
    raise ValueError(f"method is {method!r}, choose rof, tgv or auto")


def _proof(solution: Solution, operator: SurfaceOperator, scale: float) -> dict[str, Any]:
    """What is proved of a solution; its distance to the minimiser as a root mean square over the area, in the map's unit."""
    area = float(operator.mass.sum())
    return {
        "relative_gap": solution.relative_gap,
        "error_bound": None if solution.error_bound is None else solution.error_bound * scale / np.sqrt(area),
        "converged": solution.converged,
        "iterations": solution.iterations,
    }


def smooth(surface: SurfaceLike, values: MapLike, width: float, *, method: Literal["heat"] = "heat") -> DenoisedMap:
    """Smooth a map by heat flow on the surface, as wide as a Gaussian kernel of a given full width at half maximum.

    On a plane heat flow for the time t is convolution with a Gaussian of variance 2 t; t = width^2 / (16 ln 2).

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
    values : str or (n,) or (n, c) float64
        As in `denoise`.
    width : float
        Full width at half maximum, in the unit of the surface (mm, say).
    method : "heat"
        The kernel of linear finite elements with lumped mass, by the Chebyshev series of the exponential.

    Returns
    -------
    DenoisedMap
        With the mean of the map over its mask unchanged.

    Raises
    ------
    ValueError
        If the map does not fit or the width is not positive.

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=3)
    >>> bool(sx.smooth(sphere, sphere.mesh.vertices[:, 2], 0.5).values.max() < 1.0)
    True
    """
    width = real_number(width, "width", above=0.0, below=WIDEST)
    owner = as_surface(surface)
    rough = as_map(owner, values)
    part = part_for(owner, rough)
    operator = fem(part.mesh)
    image = plausible(np.asarray(part.restrict(rough), dtype=np.float64))
    time = width**2 / (16.0 * np.log(2.0))
    centre = image.mean(axis=0)
    smoothed, certificate, notes = _heat(operator, image - centre, time)
    smoothed += centre
    certificate |= {"width": width, "time": time}
    certificate["change_of_mean"] = _change_of_mean(operator, part, rough, smoothed)
    return DenoisedMap(part.extend(smoothed), method, certificate, (*part.notes, *notes), name_of(values))


def _heat(operator: SurfaceOperator, image: Floats, time: float) -> tuple[Floats, dict[str, Any], tuple[str, ...]]:
    """Return the map after a time of heat flow, what is known of its error, and what has to be said."""
    terms = np.sqrt(time * largest_eigenvalue_bound(operator))
    if terms <= MOST_TERMS:
        smoothed, degree, error = heat_polynomial(operator, image, time)
        return smoothed, {"degree": degree, "relative_error_bound": error}, ()
    note = f"Slivers ask for {terms:.0f} terms of the heat kernel: {HEAT_STEPS} implicit steps were taken instead."
    return heat_flow(operator, image, time, HEAT_STEPS), {"steps": HEAT_STEPS}, (note,)


def _change_of_mean(operator: SurfaceOperator, part: SurfacePart, before: Floats, after: Floats) -> float:
    difference = operator.mass @ (after - np.asarray(part.restrict(before), dtype=np.float64))
    return float(np.abs(difference).max() / operator.mass.sum())
