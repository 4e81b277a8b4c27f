"""Pencils that are hard on purpose: unions of equal and nearly equal copies, slivers, components of very different size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from hypothesis import strategies as st
from scipy.linalg import eigh
from scipy.sparse import block_diag, csr_array

from surfexp.contract.arrays import Floats
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem

MESHES = {
    "tetrahedron": TriangleMesh(
        np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]),
        np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]),
    ),
    "icosahedron": icosphere(0).mesh,
    "sphere": icosphere(2).mesh,
    "disk": disk(5).mesh,
    "torus": torus(12, 8).mesh,
}
LARGEST = 700


@dataclass(frozen=True, eq=False)
class Pencil:
    """Stiffness, mass, and all eigenvalues: zeros exactly, the others by dense algebra."""

    stiffness: csr_array
    mass: csr_array
    values: Floats


def pencil_of(meshes: list[TriangleMesh]) -> tuple[csr_array, csr_array]:
    operators = [fem(mesh) for mesh in meshes]
    return (
        csr_array(block_diag([stiffness(operator) for operator in operators])),
        csr_array(block_diag([mass_matrix(operator) for operator in operators])),
    )


def dense_values(a: csr_array, b: csr_array) -> Floats:
    """All eigenvalues by scipy: small ones of the inverted pencil, large ones of the pencil itself.

    Beside slivers each of the two loses the digits of the other's half; their errors, eps lambda^2 / s and eps
    lambda_max, are equal at the geometric mean of s and lambda_max.
    """
    shift = 4.0 * np.pi / float(b.sum())
    shifted = (a + shift * b).toarray()
    scale = 1.0 / np.sqrt(np.diag(shifted))
    balance = scale[:, None] * scale
    theta = eigh(balance * b.toarray(), balance * shifted, eigvals_only=True)[::-1]
    small = 1.0 / np.maximum(theta, np.finfo(float).tiny) - shift
    large = eigh(a.toarray(), b.toarray(), eigvals_only=True)
    return np.where(large > np.sqrt(shift * large[-1]), large, small)


def with_sliver(mesh: TriangleMesh, degrees: float) -> TriangleMesh:
    """Split the first face by a point on the line from its centre to an edge, so near to it that the angle is that small."""
    a, b, c = mesh.vertices[mesh.faces[0]]
    height = 0.5 * np.linalg.norm(b - a) * np.tan(np.radians(degrees))
    middle = 0.5 * (a + b)
    inward = (c - middle) - (c - middle) @ (b - a) / ((b - a) @ (b - a)) * (b - a)
    point = middle + height * inward / np.linalg.norm(inward)
    i, j, k = mesh.faces[0]
    new = len(mesh.vertices)
    faces = np.concatenate([mesh.faces[1:], [[i, j, new], [j, k, new], [k, i, new]]])
    return TriangleMesh(np.concatenate([mesh.vertices, point[None]]), faces)


@st.composite
def meshes(draw: st.DrawFn) -> list[TriangleMesh]:
    """Up to 700 vertices in up to 60 components: copies of up to three meshes, perturbed or not, some with a sliver."""
    result: list[TriangleMesh] = []
    rng = np.random.default_rng(draw(st.integers(0, 2**31)))
    for _ in range(draw(st.integers(1, 3))):
        mesh = MESHES[draw(st.sampled_from(sorted(MESHES)))]
        if draw(st.booleans()):
            mesh = with_sliver(mesh, 10.0 ** -draw(st.floats(-0.5, 5.0)))
        size = 10.0 ** draw(st.floats(-1.5, 1.5))
        copies = draw(st.integers(1, 20))
        spread = draw(st.sampled_from([0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1]))
        for factor in 1.0 + spread * rng.normal(size=copies):
            if sum(len(m.vertices) for m in result) + len(mesh.vertices) > LARGEST:
                break
            result.append(TriangleMesh(size * factor * mesh.vertices, mesh.faces))
    return result


@st.composite
def pencils_and_counts(draw: st.DrawFn) -> tuple[Pencil, int]:
    """A pencil and a number of pairs, often one that cuts or ends a cluster of eigenvalues."""
    parts = draw(meshes())
    a, b = pencil_of(parts)
    values = dense_values(a, b)
    values[: len(parts)] = (
        0.0  # constants on each component, exactly; dense algebra leaves rounding of the slivers there
    )
    n = len(values)
    gaps = np.diff(values) / np.maximum(np.abs(values[1:]), 4.0 * np.pi / float(b.sum()))
    ends = np.flatnonzero(gaps > 1e-3)[: n // 3 + 1] + 1
    end = int(draw(st.sampled_from(ends.tolist()))) if len(ends) else n
    k = draw(st.one_of(st.just(end), st.just(end - 1), st.just(end + 1), st.integers(1, n)))
    return Pencil(a, b, values), int(np.clip(k, 1, n))
