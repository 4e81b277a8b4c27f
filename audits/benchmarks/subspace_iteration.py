"""The hierarchical subspace iteration of Nasikun and Hildebrandt (2022), a rival with our factorisation.

Subspaces of functions around samples of the vertices, partitions of unity by lengths along edges; the coarsest problem
is dense, and on each finer level a block is iterated with a factorised shift until its residual is small. Written here,
since no package has it.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_array, vstack
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from surfexp.contract.arrays import Floats, Integers
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.triangle_mesh import TriangleMesh

COARSEST, REACH, CHUNK = 3.0, 2.5, 256
COARSE_RESIDUAL, MOST_ITERATIONS = 1e-2, 200


def hierarchical_subspace_iteration(
    mesh: TriangleMesh, stiffness: csr_array, mass: csr_array, count: int, tolerance: float, larger: float = 1.5
) -> tuple[Floats, Floats, int]:
    """Return values, vectors and the number of iterations on the finest level.

    Parameters
    ----------
    mesh : TriangleMesh
    stiffness, mass : (n, n) csr_array
    count : int
    tolerance : float
        Largest |A x - lambda B x| / (lambda |B x|) of the pairs that are asked for, constants aside.
    larger : float
        Vectors of the block over the pairs that are asked for.
    """
    block = round(larger * count)
    n = len(mesh.vertices)
    sizes = [round(COARSEST * block)]
    sizes.append(round(np.sqrt(sizes[0] * n)))
    levels = [_partition(mesh, _samples(mesh, size)) for size in sizes if size < 0.5 * n]
    coarse = levels[0]
    _, found = eigh((coarse.T @ stiffness @ coarse).toarray(), (coarse.T @ mass @ coarse).toarray())
    vectors = coarse @ found[:, :block]
    for basis in levels[1:]:
        reduced = basis.T @ stiffness @ basis, basis.T @ mass @ basis
        # the best coefficients of the coarse functions in the finer space
        start = ldlt(csr_array(reduced[1])).solve(basis.T @ (mass @ vectors))
        vectors = basis @ _iterated(csr_array(reduced[0]), csr_array(reduced[1]), start, count, COARSE_RESIDUAL)[1]
    values, vectors, iterations = _iterated(stiffness, mass, vectors, count, tolerance)
    return values[:count], vectors[:, :count], iterations


def _iterated(
    stiffness: csr_array, mass: csr_array, vectors: Floats, count: int, tolerance: float
) -> tuple[Floats, Floats, int]:
    values, vectors = _ritz(stiffness, mass, vectors)
    # in the middle of what is asked for, where the block converges fastest, and not at an eigenvalue
    factor = ldlt(csr_array(stiffness - 0.5003 * values[count - 1] * mass))
    for iteration in range(1, MOST_ITERATIONS + 1):
        values, vectors = _ritz(stiffness, mass, factor.solve(mass @ vectors))
        wanted = vectors[:, 1:count]
        loads = mass @ wanted
        rest = np.linalg.norm(stiffness @ wanted - loads * values[1:count], axis=0)
        if (rest / (values[1:count] * np.linalg.norm(loads, axis=0))).max() <= tolerance:
            return values, vectors, iteration
    raise ValueError(f"{MOST_ITERATIONS} iterations did not reach the residual {tolerance:g}")


def _ritz(stiffness: csr_array, mass: csr_array, vectors: Floats) -> tuple[Floats, Floats]:
    vectors = vectors / np.sqrt((vectors * (mass @ vectors)).sum(axis=0))
    values, turn = eigh(vectors.T @ (stiffness @ vectors), vectors.T @ (mass @ vectors))
    return values, vectors @ turn


def _samples(mesh: TriangleMesh, count: int) -> Integers:
    """Vertices that lie apart, on a folded surface also by their normals; about `count`."""
    reach = np.sqrt(mesh.area / count)
    places = np.concatenate([mesh.vertices, 0.5 * reach * mesh.vertex_normals], axis=1)
    tree, free, chosen = cKDTree(places), np.ones(len(places), bool), []
    for vertex in np.random.default_rng(0).permutation(len(places)):
        if free[vertex]:
            chosen.append(vertex)
            free[tree.query_ball_point(places[vertex], 0.85 * reach)] = False
    return np.array(chosen)


def _partition(mesh: TriangleMesh, samples: Integers) -> csr_array:
    """(n, s) hats 1 - d / reach around samples, d along edges, that sum to 1."""
    lengths = np.linalg.norm(mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]], axis=1)
    n = len(mesh.vertices)
    graph = csr_array((lengths, tuple(mesh.edges.T)), shape=(n, n))
    reach = REACH * np.sqrt(mesh.area / len(samples))
    rows = []
    for first in range(0, len(samples), CHUNK):
        distances = dijkstra(graph, directed=False, indices=samples[first : first + CHUNK], limit=reach)
        rows.append(csr_array(np.where(np.isfinite(distances), np.maximum(1.0 - distances / reach, 1e-12), 0.0)))
    hats = csr_array(vstack(rows).T)
    hats.data /= np.repeat(hats.sum(axis=1), np.diff(hats.indptr))
    return hats
