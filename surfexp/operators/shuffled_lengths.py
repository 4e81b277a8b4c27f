"""The same triangles with their edge lengths shuffled: a surface's geometry taken away, its connectivity left."""

from __future__ import annotations

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import check_mesh
from surfexp.operators.intrinsic_delaunay import hat_gradients_from_lengths
from surfexp.operators.surface_operator import SurfaceOperator

SWEEPS = 100
EQUAL = 1e-12


def shuffled_lengths(mesh: TriangleMesh, seed: int = 0, sweeps: int = SWEEPS) -> SurfaceOperator:
    """Return linear elements on an intrinsic metric whose edge lengths are those of the mesh in another order.

    A random order breaks the triangle inequality somewhere. So two edges at a time exchange their lengths, and do so
    only where all triangles at them stay triangles, none thinner than the thinnest of the mesh. All orders of this
    kind that can be reached are equally likely in the limit, for every exchange is as likely as its reverse. Nothing
    is repaired, and no length is changed.

    Parameters
    ----------
    mesh : TriangleMesh
    seed : int
    sweeps : int
        Exchanges that are tried, over the number of edges.

    Returns
    -------
    SurfaceOperator
        Without frames. Metrics: `accepted`, the share of tries that were exchanges; `moved`, the share of edges with
        another length; `correlation` of the lengths after with those before, 1 where all are equal.

    Raises
    ------
    ValueError
        As `fem`, or if sweeps is below 1.
    """
    check_mesh(mesh)
    if sweeps < 1:
        raise ValueError(f"sweeps = {sweeps}, take at least 1")
    ends = mesh.vertices[mesh.edges]
    before = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    lengths = before.copy()
    sides = before[mesh.face_edges]
    longest = sides.max(axis=1)
    thinnest = float(((sides.sum(axis=1) - 2.0 * longest) / longest).min())
    tries = sweeps * len(lengths)
    pairs = np.random.default_rng(seed).integers(len(lengths), size=(tries, 2))
    accepted = _exchange(lengths, mesh.face_edges, *_faces_at(mesh), pairs, thinnest)
    hats, areas = hat_gradients_from_lengths(lengths[mesh.face_edges])
    metrics = {
        "accepted": accepted / tries,
        "moved": float((lengths != before).mean()),
        "correlation": float(np.corrcoef(before, lengths)[0, 1]) if np.ptp(before) > EQUAL * before.max() else 1.0,
    }
    return SurfaceOperator(mesh.faces, hats, areas, len(mesh.vertices), name="shuffled_lengths", metrics=metrics)


def _faces_at(mesh: TriangleMesh) -> tuple[Integers, Integers]:
    """Where the faces of each edge begin in a list, and the list."""
    return mesh.edge_table.starts, mesh.edge_table.half_edges // 3


@njit(cache=True, nogil=True)
def _exchange(
    lengths: Floats, face_edges: Integers, starts: Integers, owners: Integers, pairs: Integers, thinnest: float
) -> int:
    """Exchange lengths, in place, where triangles allow it; return how often."""
    accepted = 0
    for t in range(len(pairs)):
        a, b = pairs[t, 0], pairs[t, 1]
        if a == b:
            continue
        lengths[a], lengths[b] = lengths[b], lengths[a]
        whole = True
        for edge in (a, b):
            for place in range(starts[edge], starts[edge + 1]):
                f = owners[place]
                x, y, z = lengths[face_edges[f, 0]], lengths[face_edges[f, 1]], lengths[face_edges[f, 2]]
                longest = max(x, y, z)
                if x + y + z - 2.0 * longest < thinnest * longest:
                    whole = False
        if whole:
            accepted += 1
        else:
            lengths[a], lengths[b] = lengths[b], lengths[a]
    return accepted
