"""The flux of the gradient of the distance to the boundary (5.9), and the weights made of it (5.10)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.calculus import gradient
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator


def vertex_gradients(operator: SurfaceOperator, values: Floats) -> Floats:
    """(n, 3) gradients in space at the vertices: the mean over the faces around each, weighted by area.

    Raises
    ------
    ValueError
        If the operator has no frames in space.
    """
    if operator.frames is None:
        raise ValueError(f"operator {operator.name!r} has no frames in space, take fem")
    in_space = np.einsum("fa,fax->fx", gradient(operator, values), operator.frames) * operator.areas[:, None]
    corners, repeated = operator.faces.ravel(), np.repeat(in_space, 3, axis=0)
    total = np.stack([np.bincount(corners, x, operator.vertex_count) for x in repeated.T], axis=1)
    return total / (3.0 * operator.mass)[:, None]


def flux(mesh: TriangleMesh, distance: Floats) -> Floats:
    """The flux measure (5.9), most negative on the skeleton: mean over neighbours j of <(V_j - V_i) / |V_j - V_i|, grad D(V_j)>.

    Parameters
    ----------
    mesh : TriangleMesh
    distance : (n,) float64
        D of (5.6).

    Returns
    -------
    (n,) float64
        In [-1, 1] where |grad D| <= 1.
    """
    gradients = vertex_gradients(fem(mesh), distance)
    first, second = mesh.edges.T
    direction = mesh.vertices[second] - mesh.vertices[first]
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    outward = np.einsum("ex,ex->e", direction, gradients[second])
    backward = -np.einsum("ex,ex->e", direction, gradients[first])
    count = np.bincount(mesh.edges.ravel(), minlength=len(mesh.vertices))
    total = np.bincount(first, outward, len(count)) + np.bincount(second, backward, len(count))
    return total / np.maximum(count, 1)


def skeleton_points(mesh: TriangleMesh, flux_values: Floats, threshold: float = -0.35) -> Integers:
    """Vertices where the flux is least among the neighbours and below a threshold, increasing: points of the skeleton.

    Parameters
    ----------
    mesh : TriangleMesh
    flux_values : (n,) float64
        As in `flux`.
    threshold : float
        Negative; the nearer to 0, the more of the branches that run into corners of the boundary are touched.

    Raises
    ------
    ValueError
        If the threshold is not negative.
    """
    if not threshold < 0:
        raise ValueError(f"flux threshold is {threshold}, it must be negative; -0.35 is a usual choice")
    least = flux_values < threshold
    for one, other in (mesh.edges.T, mesh.edges.T[::-1]):
        least[one[flux_values[one] > flux_values[other]]] = False
    return np.flatnonzero(least)


def flux_weights(flux_values: Floats, alpha: float = 0.25, contrast: float = 1.0) -> Floats:
    """Weights w = exp(-contrast sign(F) |F|^alpha): (5.10) for contrast = 1, where w lies in [1/e, e] because |F| <= 1.

    Raises
    ------
    ValueError
        If alpha or the contrast is not positive.
    """
    if not alpha > 0 or not contrast > 0:
        raise ValueError(f"alpha = {alpha} and contrast = {contrast}, both must be above 0")
    return np.exp(-contrast * np.sign(flux_values) * np.abs(flux_values) ** alpha)


def weighted_operator(operator: SurfaceOperator, weights: Floats, name: str = "weighted") -> SurfaceOperator:
    """The operator of div(w grad) with the mass of `operator`: gradients are scaled by the root of the mean w of each face.

    Parameters
    ----------
    operator : SurfaceOperator
    weights : (n,) float64
        Positive.

    Raises
    ------
    ValueError
        If a weight is not positive, or there is not one for each vertex.
    """
    if np.shape(weights) != (operator.vertex_count,) or not (weights > 0).all() or not np.isfinite(weights).all():
        raise ValueError(
            f"weights have shape {np.shape(weights)}; {operator.vertex_count} finite positive ones are needed"
        )
    on_faces = weights[operator.faces].mean(axis=1)
    metrics = {"smallest_weight": float(weights.min()), "largest_weight": float(weights.max())}
    return replace(
        operator,
        hats=operator.hat_gradients * np.sqrt(on_faces)[:, None, None],
        averaged_gradient=None,
        name=name,
        metrics={**operator.metrics, **metrics},
    )


def weight_far_from_boundary(mesh: TriangleMesh, weights: Floats, distance: Floats, share: float = 0.1) -> float:
    """Return the mean weight of the vertices farthest from the boundary over the mean of all, both by area.

    Parameters
    ----------
    mesh : TriangleMesh
    weights : (n,) float64
        Of (5.10).
    distance : (n,) float64
        To the boundary.
    share : float
        Of the vertices that count as far.
    """
    areas = mesh.vertex_areas
    far = distance >= np.quantile(distance, 1.0 - share)
    return float(np.average(weights[far], weights=areas[far]) / np.average(weights, weights=areas))
