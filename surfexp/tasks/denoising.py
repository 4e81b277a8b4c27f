"""Denoising and smoothing of maps on a surface."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.given_numbers import given_threads, one_of, real_number
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.absurd_values import refuse_absurd_values
from surfexp.smoothing.heat_polynomial import heat_polynomial, largest_eigenvalue_bound
from surfexp.tasks.automatic_denoising import automatically_denoised
from surfexp.tasks.denoised_map import DenoisedMap, Evidence
from surfexp.tasks.given_map import MapLike, as_map, name_of
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.noisy_image import noisy_image
from surfexp.tasks.part_of_task import part_for
from surfexp.variational.fidelity import Progress
from surfexp.variational.fitted_noise import FittedNoise
from surfexp.variational.generalised_variation import GeneralisedVariation
from surfexp.variational.own_unit import own_unit
from surfexp.variational.separable_quadratic import SeparableQuadratic, rof
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.generalised_splitting import generalised_splitting
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.surface_flows import heat_flow

NEWTON_BELOW = 1e-6
WEIGHT, RATIO = 0.9, 2.0
TOLERANCE, TOLERANCE_OF_AUTO = 1e-4, 1e-3
# their squares are times
NARROWEST, WIDEST = 1e-110, 1e110
# time times the largest eigenvalue; a polynomial of some thousand terms
LONGEST_POLYNOMIAL = 1e6
SMALL_STEPS = 100


def denoise(
    surface: SurfaceLike,
    values: MapLike,
    *,
    method: Literal["auto", "rof", "tgv"] = "auto",
    weight: float | None = None,
    ratio: float | None = None,
    noise: float | FittedNoise | None = None,
    tolerance: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> DenoisedMap:
    """Remove noise from a map by the filters that promise the least error for the noise that the map shows.

    "auto" reads the noise from the map (`noise` says what it is), replaces outliers, and mixes the heat kernel, TV, and TV
    that costs less at edges, each with its best parameter, so that Stein's estimate of the error is least. Where the noise has
    heavy tails, values far from the smoothed map are drawn towards it before a second and a third pass.

    "rof" minimises ``TV(u) + mu/2 |u - f|^2`` with ``mu = weight / (noise * h)``, h the side of the equilateral triangle of
    mean area (Rudin, Osher and Fatemi), and proves how near the result is to the minimiser. "tgv" penalises the total
    generalised variation of second order instead, which avoids staircasing where a map has slopes as well as edges.

    Values outside the mask have no influence: the condition at its boundary is natural.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        The map is denoised inside the mask, or where it is finite if there is no mask.
    values : str or (n,) or (n, c) float64
        Name of a map of the surface, or the map; NaN where nothing is known.
    method : {"auto", "rof", "tgv"}
        "auto" takes one channel, and several channels by "rof"; "tgv" takes one.
    weight : float, optional
        Of "rof" and "tgv", dimensionless, 0.9 if not given; smaller is smoother. The error is smallest near 1.
    ratio : float, optional
        Of "tgv": the length over which a slope may change, in edge lengths h, 2 if not given; a large ratio acts like "rof".
    noise : float or FittedNoise, optional
        Standard deviation of the noise, in the unit of the map, or what `noise` has read, as from a second measurement;
        estimated from the map if not given.
    tolerance : float, optional
        Largest relative duality gap. If not given, 1e-3 for one channel by "auto", else 1e-4.
    threads : int, optional
        Of "auto", which solves the map and the map with a probe side by side: all cores if not given; the bytes are the same.
    progress : callable, optional
        Receives the iteration and the gap, of one minimisation after the other.

    Returns
    -------
    DenoisedMap
        `values`, and the certificate with noise, relative_gap and error_bound (largest possible root-mean-square distance to
        the exact minimiser, or mixture of minimisers, in the unit of the map). Of "auto" also: noise_kind, outliers (how
        many), chosen and parameter (the method with the largest share; a full width at half maximum, or a weight),
        share_METHOD and parameter_METHOD where several are mixed, risk and risk_error (estimated mean square error over the
        variance of the noise, and its standard error). With heavy tails there is no risk but drawn_in (how many values).

    Raises
    ------
    ValueError
        If the map does not fit, is constant while its noise is not given, has values far from all others (a code for no
        data), a parameter is out of its range, or belongs to another method.

    References
    ----------
    Rudin, Osher, Fatemi: Nonlinear total variation based noise removal algorithms (1992).
    Stein: Estimation of the mean of a multivariate normal distribution (1981).

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=3)
    >>> noisy = sphere.mesh.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(642)
    >>> clean = sx.denoise(sphere, noisy)
    >>> bool(np.abs(clean.values - sphere.mesh.vertices[:, 2]).mean() < 0.03)
    True
    """
    one_of(method, "method", ("auto", "rof", "tgv"))
    _no_foreign(method, weight, ratio)
    weight = real_number(WEIGHT if weight is None else weight, "weight", above=0.0)
    ratio = real_number(RATIO if ratio is None else ratio, "ratio", above=0.0)
    if tolerance is not None:
        tolerance = real_number(tolerance, "tolerance", above=1e-15, below=1.0)
    threads = given_threads(threads)
    image = noisy_image(surface, values, noise)
    part, operator = image.part, image.operator
    notes = part.notes
    if method == "auto":
        if image.values.ndim == 1:
            found = automatically_denoised(image, tolerance or TOLERANCE_OF_AUTO, threads, progress)
            return replace(found, name=image.name)
        method = "rof"
        notes += (f"The map has {image.values.shape[1]} channels: method auto takes one, they were denoised by rof.",)
    tolerance = tolerance or TOLERANCE
    sigma, said = image.noise()
    facts: dict[str, Any] = {"noise": sigma, "noise_estimated": noise is None, "weight": weight}
    facts |= {"ratio": ratio} if method == "tgv" else {}
    data = rof(operator.mass, image.values, image.data_weight(weight, sigma))
    solution, slopes = _minimised(method, data, operator, ratio, tolerance, progress)
    notes += solution.notes + said
    evidence = Evidence(part, image.values, solution, slopes, tolerance)
    facts |= _proof(solution, operator)
    given = image.on_whole(image.values)
    return DenoisedMap(
        image.on_whole(solution.values), method, facts, notes, image.name, evidence=evidence, given=given
    )


def _no_foreign(method: str, weight: float | None, ratio: float | None) -> None:
    """Refuse a parameter that the method does not read."""
    if method == "auto" and weight is not None:
        raise ValueError(f"weight = {weight} belongs to method rof or tgv, auto chooses its own: give method='rof'")
    if method != "tgv" and ratio is not None:
        raise ValueError(f"ratio = {ratio} belongs to method tgv, the method is {method}: give method='tgv'")


def _minimised(
    method: str,
    data: SeparableQuadratic,
    operator: SurfaceOperator,
    ratio: float,
    tolerance: float,
    progress: Progress | None,
) -> tuple[Solution, Floats]:
    """Solve the model that a method stands for, by the solver that suits the tolerance; return the slopes of "tgv" too."""
    if method == "tgv":
        problem = GeneralisedVariation(data, operator, ratio * operator.edge_length)
        found = generalised_splitting(problem, tolerance=tolerance, progress=progress)
        return found.solution, found.slopes
    solver = newton if tolerance < NEWTON_BELOW and len(data.shape) == 1 else primal_dual
    return solver(data, operator, tolerance=tolerance, progress=progress), np.empty((0, 2))


def _proof(solution: Solution, operator: SurfaceOperator) -> dict[str, Any]:
    """What is proved of a solution; its distance to the minimiser as a root mean square over the area."""
    area = float(operator.mass.sum())
    return {
        "relative_gap": solution.relative_gap,
        "error_bound": None if solution.error_bound is None else float(solution.error_bound / np.sqrt(area)),
        "converged": solution.converged,
        "iterations": solution.iterations,
    }


def smooth(surface: SurfaceLike, values: MapLike, width: float, *, method: Literal["heat"] = "heat") -> DenoisedMap:
    """Smooth a map by heat flow on the surface, as wide as a Gaussian kernel of a given full width at half maximum.

    On a plane heat flow for the time t is convolution with a Gaussian of variance 2 t; t = width^2 / (16 ln 2). The variance
    of the kernels is that of this width within 1 % in the mean, from two edges on. Their half maximum lies at the width within
    1 / k^2 where that is k edges: 1 % from 10 edges on, 3 % at 6.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
    values : str or (n,) or (n, c) float64
        As in `denoise`.
    width : float
        Full width at half maximum, in the unit of the surface (mm, say).
    method : "heat"
        The heat kernel of linear finite elements with lumped mass, by a polynomial of which `error` bounds what is left
        out. Where slivers of triangles would need thousands of terms, a hundred implicit `steps` in their place, whose
        kernel is 1 % narrower.

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
    one_of(method, "method", ("heat",))
    width = real_number(width, "width", above=NARROWEST, below=WIDEST)
    owner = as_surface(surface)
    rough = as_map(owner, values)
    part = part_for(owner, rough)
    operator = fem(part.mesh)
    time = (width / part.length) ** 2 / (16.0 * np.log(2.0))
    inside = np.asarray(part.restrict(rough), dtype=np.float64)
    refuse_absurd_values(inside, part.vertices)
    own = own_unit(inside)
    certificate: dict[str, Any] = {"width": width, "time": time * part.length**2}
    if time * largest_eigenvalue_bound(operator) <= LONGEST_POLYNOMIAL:
        kernel = heat_polynomial(operator, own.normalised(inside), time)
        smoothed, certificate["degree"], certificate["error"] = kernel
    else:
        smoothed = heat_flow(operator, own.normalised(inside), time, SMALL_STEPS)
        certificate["steps"] = SMALL_STEPS
    smoothed = own.restored(smoothed)
    certificate["change_of_mean"] = _change_of_mean(operator, part, rough, smoothed)
    notes = (*part.notes, *_wide(part, width))
    return DenoisedMap(part.extend(smoothed), method, certificate, notes, name_of(values), given=part.extend(inside))


def _wide(part: SurfacePart, width: float) -> Iterator[str]:
    """Say where a kernel is wider than all of the surface, as if the width were in another unit."""
    extent = float(np.linalg.norm(np.ptp(part.mesh.vertices, axis=0))) * part.length
    if width > extent:
        yield f"The width {width:g} is more than the extent of the surface, {extent:.3g}: the result is close to its mean."


def _change_of_mean(operator: SurfaceOperator, part: SurfacePart, before: Floats, after: Floats) -> float:
    difference = operator.mass @ (after - np.asarray(part.restrict(before), dtype=np.float64))
    return float(np.abs(difference).max() / operator.mass.sum())
