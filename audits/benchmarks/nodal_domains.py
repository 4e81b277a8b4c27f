"""Nodal domains of all eigenfunctions, against scipy's connected components function by function."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from audits.benchmarks.line import Line, race
from audits.benchmarks.measurement import measure_both
from audits.benchmarks.scenes import cortex_scene
from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.nodal_domains import nodal_counts
from surfexp.spectrum.nodal_graph import nodal_graph


def warm_up() -> None:
    """Compile what the line uses."""
    mesh = icosphere(2).mesh
    nodal_counts(nodal_graph(mesh.faces, len(mesh.vertices)), np.asfortranarray(mesh.vertices))


def lines(quick: bool) -> list[Line]:
    """Return the line of 300 functions on 39,994 vertices."""
    size, count = (10000, 40) if quick else (39994, 300)
    mesh = cortex_scene(size).surface.mesh
    operator = fem(mesh)
    vectors = eigenpairs(stiffness(operator), mass_matrix(operator), count).vectors
    edges = np.unique(np.sort(mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    graph = nodal_graph(mesh.faces, len(mesh.vertices))
    nodal_counts(graph, vectors[:, :1])
    (ours, cost), (theirs, their_cost) = measure_both(
        lambda: nodal_counts(graph, vectors), lambda: _components(edges, vectors)
    )
    same = bool((ours == theirs).all())
    accuracy = f"counts equal: {'yes' if same else f'{(ours == theirs).sum()} of {count}'}"
    work, rival = f"nodal domains of {count} functions, {len(mesh.vertices):,} V", "scipy connected_components"
    note = "both are handed the graph of the mesh, the rival as its list of edges"
    return [race(work, rival, 5, cost, their_cost, accuracy, fair=same, note=note)]


def _components(edges: Integers, vectors: Floats) -> Integers:
    counts = np.empty(vectors.shape[1], np.int64)
    first, second = np.ascontiguousarray(edges.T)
    for column, values in enumerate(vectors.T):
        sign = np.sign(values)
        kept = sign[first] * sign[second] > 0
        graph = coo_array((np.ones(kept.sum(), np.int8), (first[kept], second[kept])), shape=(len(sign), len(sign)))
        counts[column] = connected_components(graph.tocsr(), directed=False)[0] - (sign == 0).sum()
    return counts
