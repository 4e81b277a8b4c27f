"""Tangent fields of Crouzeix and Raviart: a vector at the middle of each edge, the same one on both of its faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.edge_table import edge_table
from surfexp.operators.surface_operator import SurfaceOperator


@dataclass(frozen=True, eq=False)
class TangentFields:
    """The space of tangent fields that are linear on faces and continuous in the middle of edges.

    Two faces are flat about their common edge, so a vector there has the same two coordinates in both, along the edge
    (from its vertex of smaller index to the other one) and across it; nothing has to be chosen at vertices, where the
    surface is curved. On a plane all linear fields are among these, and constant ones have no derivative.

    Parameters
    ----------
    edges : (e, 2) int64
        Smaller vertex first, sorted.
    averages : (2 m, 2 e) csr_array
        Mean of a field over each face in the frame of the face; row 2 f + a is component a.
    derivative : (4 m, 2 e) csr_array
        Covariant derivative on each face; row 4 f + 2 a + b is the derivative of component a in direction b.
    """

    edges: Integers
    averages: csr_array
    derivative: csr_array


def tangent_fields(operator: SurfaceOperator) -> TangentFields:
    """Return the fields of Crouzeix and Raviart over the faces of an operator; they need no embedding.

    Parameters
    ----------
    operator : SurfaceOperator

    Returns
    -------
    TangentFields

    Raises
    ------
    ValueError
        If an edge has more than two faces, as where an intrinsic triangulation joins two vertices by several edges.

    References
    ----------
    Stein, Wardetzky, Jacobson, Grinspun: A simple discretization of the vector Dirichlet energy (2020).
    """
    edges, face_edges, along = _edges_in_frames(operator)
    across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    axes = np.stack([along, across], axis=-1)  # (m, 3, component, coordinate)
    slopes = -2.0 * operator.hat_gradients
    count, columns = len(operator.faces), 2 * face_edges[:, :, None] + np.arange(2)
    means = np.moveaxis(axes / 3.0, 2, 1).reshape(2 * count, 6)
    derivatives = np.einsum("fkac,fkb->fabkc", axes, slopes).reshape(4 * count, 6)
    return TangentFields(edges, _rows(means, columns, len(edges)), _rows(derivatives, columns, len(edges)))


def _edges_in_frames(operator: SurfaceOperator) -> tuple[Integers, Integers, Floats]:
    """Return the edges, the edge opposite each corner (m, 3), and its direction in the face's frame (m, 3, 2)."""
    tails, heads = operator.faces[:, [1, 2, 0]], operator.faces[:, [2, 0, 1]]
    table = edge_table(tails.ravel(), heads.ravel(), operator.vertex_count)
    edges, face_edges, counts = table.edges, table.edge_of, table.counts
    if counts.max(initial=0) > 2:
        worst = int(np.argmax(counts))
        raise ValueError(
            f"edge {edges[worst].tolist()} has {counts[worst]} faces in operator {operator.name!r}, at most 2 can "
            "carry tangent fields: repair the surface, or choose operator fem"
        )
    hats = operator.hat_gradients
    forward = np.where(tails < heads, 1.0, -1.0)[..., None] * np.stack([hats[..., 1], -hats[..., 0]], axis=-1)
    return edges, face_edges.reshape(-1, 3), forward / np.linalg.norm(forward, axis=-1, keepdims=True)


def _rows(entries: Floats, columns: Integers, edge_count: int) -> csr_array:
    """Return the matrix whose rows, several to a face, share the six columns of the face."""
    repeated = np.repeat(columns.reshape(-1, 6), len(entries) // len(columns), axis=0)
    starts = np.arange(0, entries.size + 1, 6)
    return csr_array((entries.ravel(), repeated.ravel(), starts), shape=(len(entries), 2 * edge_count))
