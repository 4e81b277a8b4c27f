"""Errors of eigenfunctions of linear elements against exact ones, the bound (3.24), and what midpoints gain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.special import sph_harm_y

from surfexp.contract.arrays import Floats
from surfexp.mesh.exact_spectra import rectangle_spectrum, sphere_spectrum
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.subdivision import subdivide
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_lagrange import triangle_quadrature
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs

Shape = Literal["rectangle", "sphere"]
WIDTH, HEIGHT = 1.5, 1.0
QUADRATURE = 5


@dataclass(frozen=True, eq=False)
class EigenfunctionErrors:
    """Errors of the eigenfunctions of one mesh, the constant left out.

    Parameters
    ----------
    values : (k,) float64
        Exact eigenvalues.
    errors : (k,) float64
        L2 distance of the exact normalised function to the space of the computed ones of its eigenvalue.
    edge_length : float
    """

    values: Floats
    errors: Floats
    edge_length: float


def shape_mesh(shape: Shape, level: int) -> TriangleMesh:
    """Return the mesh of a level: edges are halved from one to the next.

    Raises
    ------
    ValueError
        If the shape is unknown.
    """
    if shape == "sphere":
        return icosphere(level).mesh
    if shape == "rectangle":
        return rectangle(3 * 2**level + 1, 2 * 2**level + 1, WIDTH, HEIGHT).mesh
    raise ValueError(f"shape {shape!r} has no exact eigenfunctions here, choose rectangle or sphere")


def eigenfunction_errors(shape: Shape, level: int, count: int) -> EigenfunctionErrors:
    """Compute the first eigenfunctions with linear elements and measure them against the exact ones.

    A function of the sphere is compared on the facets, at points carried to the sphere along radii. Sides of the rectangle
    are 3 to 2 with a free boundary; values that coincide are taken as one eigenspace.

    Parameters
    ----------
    shape : "rectangle" or "sphere"
    level : int
    count : int
        Eigenfunctions after the constant.
    """
    mesh = shape_mesh(shape, level)
    groups = _groups(shape, count + 1)
    elements = surface_elements(mesh)
    system = eigenpairs(elements.stiffness, elements.mass, groups[-1][1])
    points, shares, weights = _quadrature(mesh)
    values, errors = [], []
    for start, stop, value, functions in groups:
        if start == 0:
            continue
        computed = np.einsum("qc,fck->fqk", shares, system.vectors[mesh.faces, start:stop])
        for exact in functions(points):
            exact = exact / np.sqrt((weights * exact**2).sum())
            parts = np.einsum("fq,fq,fqk->k", weights, exact, computed)
            errors.append(float(np.sqrt((weights * (exact - computed @ parts) ** 2).sum())))
            values.append(value)
    return EigenfunctionErrors(np.array(values[:count]), np.array(errors[:count]), mesh.edge_length)


def midpoint_gain(shape: Shape, level: int, count: int, project: bool) -> Floats:
    """Return by what factor the error of each eigenvalue falls when every triangle is cut into four.

    Parameters
    ----------
    project : bool
        Carry the midpoints to the smooth surface, or leave them on the facets as section 3.2 does.
    """
    coarse = shape_mesh(shape, level)
    onto = None if not project or shape == "rectangle" else _onto_sphere
    exact = sphere_spectrum(count + 1) if shape == "sphere" else rectangle_spectrum(count + 1, WIDTH, HEIGHT, "neumann")
    errors = []
    for mesh in (coarse, subdivide(coarse, onto)):
        elements = surface_elements(mesh)
        errors.append(
            np.abs(eigenpairs(elements.stiffness, elements.mass, count + 1).values / np.maximum(exact, 1e-9) - 1)
        )
    return np.asarray(errors[0][1:] / errors[1][1:])


def values_below(level: int, count: int, circumscribed: bool) -> int:
    """Return how many of the first eigenvalues of linear elements lie under those of the unit sphere, which (3.25) excludes.

    Parameters
    ----------
    level : int
        Of the icosphere.
    count : int
        Eigenvalues after 0.
    circumscribed : bool
        Push the facets out until none cuts the sphere; else the vertices lie on it.
    """
    mesh = shape_mesh("sphere", level)
    if circumscribed:
        heights = np.einsum("fx,fx->f", mesh.face_normals, mesh.vertices[mesh.faces[:, 0]])
        mesh = TriangleMesh(mesh.vertices / heights.min(), mesh.faces)
    elements = surface_elements(mesh)
    values = eigenpairs(elements.stiffness, elements.mass, count + 1).values[1:]
    return int((values < sphere_spectrum(count + 1)[1:] * (1.0 - 1e-9)).sum())


def _onto_sphere(points: Floats) -> Floats:
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def _quadrature(mesh: TriangleMesh) -> tuple[Floats, Floats, Floats]:
    """(f, q, 3) points, (q, 3) barycentric coordinates and (f, q) weights of a rule on every face."""
    places, weights = triangle_quadrature(QUADRATURE)
    shares = np.column_stack([1.0 - places.sum(axis=1), places])
    points = np.einsum("qc,fcx->fqx", shares, mesh.vertices[mesh.faces])
    return points, shares, mesh.areas[:, None] * (weights / weights.sum())[None, :]


Group = tuple[int, int, float, Callable[[Floats], list[Floats]]]


def _groups(shape: Shape, count: int) -> list[Group]:
    """First and last + 1 number, value and functions of each exact eigenspace, until `count` modes are there."""
    groups: list[Group] = []
    if shape == "sphere":
        degree = 0
        while degree**2 < count:
            groups.append((degree**2, (degree + 1) ** 2, degree * (degree + 1.0), _harmonics(degree)))
            degree += 1
        return groups
    m, n = (index.ravel() for index in np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij"))
    values = np.pi**2 * ((m / WIDTH) ** 2 + (n / HEIGHT) ** 2)
    order = np.argsort(values, kind="stable")
    start = 0
    while start < count:
        same = order[np.abs(values[order] - values[order[start]]) <= 1e-9 * (1.0 + values[order[start]])]
        functions = _cosines([(int(m[k]), int(n[k])) for k in same])
        groups.append((start, start + len(same), float(values[same[0]]), functions))
        start += len(same)
    return groups


def _harmonics(degree: int) -> Callable[[Floats], list[Floats]]:
    def evaluate(points: Floats) -> list[Floats]:
        x, y, z = np.moveaxis(points / np.linalg.norm(points, axis=-1, keepdims=True), -1, 0)
        polar, azimuth = np.arccos(np.clip(z, -1.0, 1.0)), np.arctan2(y, x)
        complex_ones = [sph_harm_y(degree, order, polar, azimuth) for order in range(degree + 1)]
        return [part for k, item in enumerate(complex_ones) for part in ((item.real, item.imag) if k else (item.real,))]

    return evaluate


def _cosines(pairs: list[tuple[int, int]]) -> Callable[[Floats], list[Floats]]:
    def evaluate(points: Floats) -> list[Floats]:
        x, y = points[..., 0] / WIDTH, points[..., 1] / HEIGHT
        return [np.cos(np.pi * m * x) * np.cos(np.pi * n * y) for m, n in pairs]

    return evaluate
