"""Global point embeddings of surfaces whose spectra are known: spheres, flat tori and ellipsoids of revolution."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh_tridiagonal
from scipy.special import sph_harm_y

from surfexp.contract.arrays import Floats
from surfexp.embedding.spectral_embedding import SpectralEmbedding, Weighting, mode_weights
from surfexp.mesh.shapes.fibonacci_sphere import fibonacci_sphere


def _embedding(values: Floats, functions: Floats, weights: Floats, n: int, weighting: Weighting) -> SpectralEmbedding:
    order = np.argsort(values, kind="stable")[:n]
    values = values[order]
    return SpectralEmbedding(functions[:, order] * mode_weights(values, weighting), weights, values, weighting)


def sphere_embedding(n: int, count: int = 2000, weighting: Weighting = "global_point") -> SpectralEmbedding:
    """Real spherical harmonics at `count` evenly spread points of the sphere of area 1; n is best a square less 1."""
    points = fibonacci_sphere(count).mesh.vertices
    polar, azimuth = np.arccos(np.clip(points[:, 2], -1, 1)), np.arctan2(points[:, 1], points[:, 0])
    values, columns = [], []
    for degree in range(1, int(np.ceil(np.sqrt(n + 1)))):
        for m in range(-degree, degree + 1):
            harmonic = sph_harm_y(degree, abs(m), polar, azimuth)
            part = harmonic.real if m >= 0 else harmonic.imag
            columns.append(np.sqrt(4.0 * np.pi) * part * (np.sqrt(2.0) if m else 1.0))
            values.append(4.0 * np.pi * degree * (degree + 1))
    weights = np.full(count, 1.0 / count)
    return _embedding(np.array(values), np.stack(columns, axis=1), weights, n, weighting)


def torus_embedding(ratio: float, n: int, points: int = 48, weighting: Weighting = "global_point") -> SpectralEmbedding:
    """Sines and cosines on points x points nodes of the flat torus of sides a and 1 / a, `ratio` being a^2."""
    if not ratio > 0:
        raise ValueError(f"ratio of the sides {ratio:g}, take a positive one")
    reach = int(np.ceil(np.sqrt(n * max(ratio, 1.0 / ratio)))) + 2
    k, l = (grid.ravel() for grid in np.meshgrid(np.arange(reach), np.arange(reach), indexing="ij"))
    u, v = (grid.ravel() for grid in np.meshgrid(*[np.arange(points) / points] * 2, indexing="ij"))
    values = 4.0 * np.pi**2 * (k**2 / ratio + l**2 * ratio)
    parts = []
    for first in (np.cos, np.sin):
        for second in (np.cos, np.sin):
            exists = ((first is np.cos) | (k > 0)) & ((second is np.cos) | (l > 0)) & (k + l > 0)
            parts += [(values[i], k[i], l[i], first, second) for i in np.flatnonzero(exists)]
    parts.sort(key=lambda part: part[0])
    # one more shell than asked for lies inside the reach, so the first n are complete
    columns = []
    for _, i, j, first, second in parts[:n]:
        factor = np.sqrt((2.0 if i else 1.0) * (2.0 if j else 1.0))
        columns.append(factor * first(2 * np.pi * i * u) * second(2 * np.pi * j * v))
    weights = np.full(len(u), 1.0 / len(u))
    return _embedding(np.array([part[0] for part in parts[:n]]), np.stack(columns, axis=1), weights, n, weighting)


def spheroid_embedding(
    axis: float, n: int, rows: int = 60, columns: int = 60, weighting: Weighting = "global_point", nodes: int = 2000
) -> SpectralEmbedding:
    """Functions u(s) cos m t and u(s) sin m t of the ellipsoid of revolution with semiaxes 1, 1, `axis`, scaled to area 1.

    u solves -(r u')' / r + m^2 u / r^2 = lambda u along the meridian, by finite volumes on `nodes` cells of equal arc
    length, of second order.
    """
    if not axis > 0:
        raise ValueError(f"semiaxis {axis:g}, take a positive one")
    t = np.linspace(0.0, np.pi, 40001)
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(np.sin(t)), axis * np.diff(np.cos(t))))])
    edges = np.interp(np.linspace(0.0, arc[-1], nodes + 1), arc, t)
    middles = np.interp(np.linspace(0.0, arc[-1], 2 * nodes + 1)[1::2], arc, t)
    step = arc[-1] / nodes
    radius, border = np.sin(middles), np.sin(edges[1:-1])
    area = 2.0 * np.pi * step * radius.sum()
    rows_at = np.linspace(0, nodes - 1, rows).round().astype(int)
    angle = 2.0 * np.pi * np.arange(columns) / columns
    values, functions = [], []
    highest = 1.3 * 4.0 * np.pi * n / area
    for m in range(int(np.sqrt(highest * max(1.0, axis) ** 2)) + 2):
        stiffness = np.zeros(nodes)
        stiffness[:-1] += border / step**2
        stiffness[1:] += border / step**2
        diagonal = stiffness / radius + m**2 / radius**2
        beside = -border / step**2 / np.sqrt(radius[:-1] * radius[1:])
        found, vectors = eigh_tridiagonal(diagonal, beside, select="v", select_range=(-1.0, highest))
        # normalised for the area 2 pi r ds, then for area 1
        along = vectors[rows_at] / np.sqrt(radius[rows_at] * step)[:, None] * np.sqrt(area / (2.0 * np.pi))
        for order in range(len(found)):
            for wave in (np.cos, np.sin) if m else (np.cos,):
                values.append(found[order] * area)
                functions.append(np.outer(along[:, order], wave(m * angle) * (np.sqrt(2.0) if m else 1.0)).ravel())
    moving = np.array(values) > 1e-6
    weights = np.repeat(radius[rows_at], columns)
    kept = np.stack(functions, axis=1)[:, moving]
    return _embedding(np.array(values)[moving], kept, weights / weights.sum(), n, weighting)
