"""The noise of a map: how large it is where, and what kind."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.fem import fem
from surfexp.smoothing.absurd_values import refuse_absurd_values
from surfexp.tasks.given_map import MapLike, as_single_map
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for
from surfexp.variational.fitted_noise import FittedNoise
from surfexp.variational.noise_reading import ROUNDING, read_noise


def noise(surface: SurfaceLike, values: MapLike, second: MapLike | None = None) -> FittedNoise:
    """Read the noise from a map: its level at each vertex, outliers, correlation and rounding.

    What is affine on a pair of triangles is none of the noise; a median over the pairs gives its level. Noise of a full
    width of 2 edges and more cannot be told from the map. A second measurement of the same map tells any noise, for the
    map is not in the difference. `denoise` and `denoise_path` take what was found as their `noise`.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        Its mask, or else the finite values of the map, is where the noise is read.
    values : str or (n,) float64
        Name of a map of the surface, or the map; NaN where nothing is known.
    second : str or (n,) float64, optional
        Another measurement of the same map.

    Returns
    -------
    FittedNoise
        `level` and `levels` in the unit of the map, `kinds` ("outliers", "varying", "smooth", "rounded", "partly constant",
        "hidden"; none for white noise), `notes` in words.

    Raises
    ------
    ValueError
        If the map does not fit, has several channels, is constant, or has values far from all others (a code for no data);
        if the second differs from it by nothing or by a constant.

    Examples
    --------
    >>> import surfexp as sx
    >>> sphere = sx.shape("icosphere", levels=4)
    >>> noisy = sphere.mesh.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(2562)
    >>> round(sx.noise(sphere, noisy).level, 2)
    0.1
    """
    owner = as_surface(surface)
    maps = [as_single_map(owner, one) for one in (values, second) if one is not None]
    part = part_for(owner, *maps)
    inside = [np.asarray(part.restrict(one), dtype=np.float64) for one in maps]
    for one in inside:
        refuse_absurd_values(one, part.vertices)
    if np.ptp(inside[0]) == 0:
        raise ValueError(f"map is constant at {inside[0][0]:g}: it has no noise")
    if second is not None:
        _refuse_the_same(*inside)
    return read_noise(fem(part.mesh), inside[0], inside[1] if second is not None else None).on_whole(part)


def _refuse_the_same(first: Floats, second: Floats) -> None:
    difference = second - first
    if np.ptp(difference) <= ROUNDING * max(np.abs(first).max(), np.abs(second).max()):
        by = f"differs from the first by {np.median(difference):.3g} everywhere"
        raise ValueError(f"the second measurement {by}: it shows no noise, give one that was measured again")
