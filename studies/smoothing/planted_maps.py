"""Maps with planted borders or planted noise, measured several times."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.smoothing.methods import heat_time
from surfexp.variational.image import Image
from surfexp.variational.surface_flows import heat_flow

REPETITIONS = 2
INSIDE = "parcels"
ROUNDING = 1e-12


def planted_parcels(
    surface: Surface, parcels: int = 12, contrast: float = 1.0, correlation: float = 0.0, seed: int = 0
) -> Image:
    """Return a map of two levels on parcels of the surface, measured twice with noise of standard deviation 1.

    The parcels are the cells of random vertices by distance along the surface; a random half of them has the level
    `contrast`, the others 0.

    Parameters
    ----------
    surface : Surface
    parcels : int
    contrast : float
        In noise levels; 0: noise alone.
    correlation : float
        Full width at half maximum to which the noise is smoothed, in the unit of the surface; 0: independent noise.
    seed : int
        Of the parcels and of the noise.

    Returns
    -------
    Image
        `values` and `clean` are (n, 2), a column for each measurement; the label "parcels" is the upper level.

    Raises
    ------
    ValueError
        If there are fewer than 2 parcels, more than vertices, or contrast or correlation is negative.
    """
    count = len(surface.mesh.vertices)
    if not 2 <= parcels <= count:
        raise ValueError(f"parcels is {parcels}, must be in 2..{count} on this surface")
    if contrast < 0 or correlation < 0:
        raise ValueError(f"contrast is {contrast:g} and correlation {correlation:g}, both must be 0 or more")
    random = np.random.default_rng(seed)
    centres = random.choice(count, parcels, replace=False)
    cell = np.stack([fast_marching(surface.mesh, np.array([centre])) for centre in centres]).argmin(axis=0)
    upper = np.isin(cell, random.choice(parcels, parcels // 2, replace=False))
    clean = np.repeat(contrast * upper.astype(float)[:, None], REPETITIONS, axis=1)
    noise = smooth_noise(surface, correlation, random)
    labels = {INSIDE: upper} if contrast > 0 else {}
    return Image(clean + noise, "planted parcels", "noise levels", clean=clean, noise=1.0, labels=labels)


def repeated_map(surface: Surface, name: str, noise: float = 0.5, seed: int = 0) -> Image:
    """Return a map of a surface in units of its deviation by area, measured twice with independent noise.

    Parameters
    ----------
    surface : Surface
        With the map, without NaN.
    name : str
    noise : float
        Standard deviation of the noise over that of the map.
    seed : int

    Returns
    -------
    Image
        `values` and `clean` are (n, 2). The map has noise of its own, so that errors against it are no absolute figures.

    Raises
    ------
    ValueError
        If the surface has no such map, it is constant, or the noise is not positive.
    """
    if name not in surface.scalars:
        known = ", ".join(surface.scalars) or "none"
        raise ValueError(f"map {name!r} is not on {surface.name}, which has {known}")
    if not noise > 0:
        raise ValueError(f"noise is {noise:g}, must be positive")
    mass, values = fem(surface.mesh).mass, np.asarray(surface.scalars[name], dtype=np.float64)
    centred = values - mass @ values / mass.sum()
    deviation = float(np.sqrt(mass @ centred**2 / mass.sum()))
    if not deviation > ROUNDING * np.abs(values).max():
        raise ValueError(f"map {name!r} is constant on {surface.name}: it has no deviation to set the noise by")
    clean = np.repeat((centred / deviation)[:, None], REPETITIONS, axis=1)
    rough = clean + noise * np.random.default_rng(seed).standard_normal(clean.shape)
    return Image(rough, name, "deviations of the map", clean=clean, noise=noise)


def smooth_noise(surface: Surface, width: float, random: np.random.Generator) -> Floats:
    """(n, 2) Gaussian noise, smoothed by heat flow of a full width at half maximum, of variance 1 by area."""
    noise: Floats = random.standard_normal((len(surface.mesh.vertices), REPETITIONS))
    if width == 0:
        return noise
    operator = fem(surface.mesh)
    # a sample of white noise on the surface has the variance 1 / area of the vertex
    smoothed = heat_flow(operator, noise / np.sqrt(operator.mass)[:, None], heat_time(width))
    variance = operator.mass @ smoothed**2 / operator.mass.sum()
    return np.asarray(smoothed / np.sqrt(variance))
