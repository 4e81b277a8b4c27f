"""Global numbers of the nodes of high-order elements: vertices, then sides, then insides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.edge_table import half_edge_table
from surfexp.operators.elements_lagrange import lagrange_nodes


@dataclass(frozen=True, eq=False)
class ElementNodes:
    """Which nodes each face has.

    Parameters
    ----------
    order : int
    connectivity : (m, b) int64
        Node numbers of each face, in the order of `LagrangeElement.nodes`; vertices keep their numbers.
    count : int
    boundary : int64 array
        Nodes on sides that have one face only, sorted.
    """

    order: int
    connectivity: Integers
    count: int
    boundary: Integers


def number_nodes(faces: Integers, vertex_count: int, order: int) -> ElementNodes:
    """Number the nodes of a triangulation so that faces share those of their common sides.

    Parameters
    ----------
    faces : (m, 3) int64
        Two faces share a side when they share both its vertices.
    vertex_count : int
    order : int
    """
    sides = np.stack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]], axis=1)
    table = half_edge_table(faces, vertex_count)
    edge_of = table.edge_of.reshape(-1, 3)
    backwards = sides[:, :, 0] > sides[:, :, 1]
    columns = [faces]
    for side in range(3):
        for step in range(1, order):
            along = np.where(backwards[:, side], order - step, step)
            columns.append((vertex_count + edge_of[:, side] * (order - 1) + along - 1)[:, None])
    inner = (order - 1) * (order - 2) // 2
    first_inner = vertex_count + len(table.edges) * (order - 1)
    columns.append(first_inner + np.arange(len(faces))[:, None] * inner + np.arange(inner))
    rim = np.flatnonzero(table.counts == 1)
    on_rim = vertex_count + rim[:, None] * (order - 1) + np.arange(order - 1)
    return ElementNodes(
        order=order,
        connectivity=np.concatenate(columns, axis=1),
        count=int(first_inner + len(faces) * inner),
        boundary=np.unique(np.concatenate([table.edges[rim].ravel(), on_rim.ravel()])),
    )


def flat_positions(corners: Floats, order: int) -> Floats:
    """(m, b, d) positions of the nodes of flat faces with the given (m, 3, d) corners."""
    return np.einsum("bk,mkd->mbd", lagrange_nodes(order), corners)
