"""Energies and duals computed again by other means than the package: the published weights (1.24), in space, by numpy."""

import numpy as np

from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.solution import Solution


def face_weights(mesh: TriangleMesh) -> np.ndarray:
    """(m, 3, 3): the vectors w of (1.24), whose sum with the values at the corners is the gradient in space."""
    points = mesh.vertices[mesh.faces]
    edges = points[:, 1:] - points[:, :1]
    metric = np.einsum("fax,fbx->fab", edges, edges)
    weights = np.einsum("fab,fbx->fax", np.linalg.inv(metric), edges)
    return np.concatenate([-weights.sum(axis=1, keepdims=True), weights], axis=1)


def heron_areas(mesh: TriangleMesh) -> np.ndarray:
    """(m,) areas from side lengths."""
    points = mesh.vertices[mesh.faces]
    a, b, c = (np.linalg.norm(points[:, k] - points[:, k - 1], axis=1) for k in range(3))
    s = 0.5 * (a + b + c)
    return np.sqrt(s * (s - a) * (s - b) * (s - c))


def total_variation(mesh: TriangleMesh, values: np.ndarray) -> float:
    """sum A |grad f|, with the Frobenius norm over channels."""
    channels = values.reshape(len(values), -1)
    gradients = np.einsum("fkx,fkc->fcx", face_weights(mesh), channels[mesh.faces])
    return float(heron_areas(mesh) @ np.sqrt((gradients**2).sum(axis=(1, 2))))


def load_of(mesh: TriangleMesh, operator: SurfaceOperator, dual: np.ndarray) -> np.ndarray:
    """G^T A p, with p taken to space by the frames of the operator; checks that |p| <= 1."""
    field = dual.reshape(len(mesh.faces), -1, 2)
    assert np.sqrt((field**2).sum(axis=(1, 2))).max() <= 1.0 + 1e-12
    assert operator.frames is not None
    in_space = np.einsum("fca,fax->fcx", field, operator.frames)
    shares = heron_areas(mesh)[:, None, None] * np.einsum("fkx,fcx->fkc", face_weights(mesh), in_space)
    load = np.zeros((len(mesh.vertices), field.shape[1]))
    np.add.at(load, mesh.faces, shares)
    return load.reshape(len(mesh.vertices), *dual.shape[1:-1])


def lumped(mesh: TriangleMesh) -> np.ndarray:
    """(n,) a third of the ring areas."""
    return np.bincount(mesh.faces.ravel(), np.repeat(heron_areas(mesh) / 3, 3))


def check(solution: Solution, energy: float, bound: float) -> None:
    """The stored numbers are these, and the bound is below."""
    assert solution.dual is not None and solution.lower_bound is not None
    scale = max(abs(energy), abs(bound))
    assert abs(solution.energy - energy) <= 1e-10 * scale
    assert abs(solution.lower_bound - bound) <= 1e-10 * scale
    assert energy >= bound - 1e-12 * scale
