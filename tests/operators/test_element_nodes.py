"""Numbers of nodes: those that sorted sides give, on drawn triangles that need not be a surface."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.operators.elements_nodes import number_nodes


@given(st.lists(st.tuples(*[st.integers(0, 6)] * 3), min_size=1, max_size=20), st.integers(1, 4))
def test_sides_with_the_same_ends_have_the_same_nodes(triangles: list[tuple[int, int, int]], order: int) -> None:
    faces = np.array(triangles, dtype=np.int64)
    nodes = number_nodes(faces, 7, order)
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, edge_of, counts = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    on_sides = nodes.connectivity[:, 3 : 3 * order].reshape(3 * len(faces), order - 1)
    assert np.array_equal(nodes.connectivity[:, :3], faces)
    assert np.array_equal((on_sides - 7) // max(order - 1, 1), np.repeat(edge_of.reshape(-1, 1), order - 1, axis=1))
    assert nodes.count == 7 + len(edges) * (order - 1) + len(faces) * (order - 1) * (order - 2) // 2
    rim = edges[counts == 1]
    assert np.array_equal(nodes.boundary[nodes.boundary < 7], np.unique(rim))
    assert len(nodes.boundary) == len(np.unique(rim)) + len(rim) * (order - 1)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_neighbours_count_a_common_side_from_the_same_end(order: int) -> None:
    nodes = number_nodes(np.array([[0, 1, 2], [2, 1, 3]]), 4, order).connectivity
    assert np.array_equal(nodes[0, 3 + order - 1 : 3 + 2 * (order - 1)], nodes[1, 3 : 3 + order - 1][::-1])
