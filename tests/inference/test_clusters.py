"""Clusters against connected components, and areas and masses by sums."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference import components, maps_with_ties, meshes

from surfexp.inference.clusters import clusters_beyond, clusters_where
from surfexp.inference.vertex_graph import graph_of_edges
from surfexp.mesh.triangle_mesh import TriangleMesh


@settings(max_examples=200, deadline=None)
@given(st.data(), meshes(), st.sampled_from([0.5, 1.0, 1.3]), st.booleans())
def test_clusters_are_the_components_of_each_sign(
    data: st.DataObject, mesh: TriangleMesh, threshold: float, two_sided: bool
) -> None:
    values = data.draw(maps_with_ties(len(mesh.vertices)))
    areas = mesh.vertex_areas + 0.1
    found = clusters_beyond(values, graph_of_edges(mesh.edges, areas), threshold, two_sided=two_sided)
    wanted = set()
    for sign in (1.0, -1.0) if two_sided else (1.0,):
        labels = components(mesh.edges, sign * values >= threshold)
        wanted |= {tuple(np.flatnonzero(labels == one)) for one in np.unique(labels[labels >= 0])}
    sets = [tuple(np.flatnonzero(found.labels == k)) for k in range(len(found.areas))]
    assert set(sets) == wanted and sets == sorted(sets)
    for k, members in enumerate(sets):
        inside = list(members)
        assert found.areas[k] == pytest.approx(areas[inside].sum())
        assert found.masses[k] == pytest.approx((np.abs(values) * areas)[inside].sum())
        assert found.peaks[k] == inside[int(np.abs(values[inside]).argmax())]


def test_named_vertices_of_two_signs_are_two_clusters() -> None:
    graph = graph_of_edges(np.array([[0, 1], [1, 2], [2, 3]]), np.ones(4))
    found = clusters_where(np.array([True, True, True, False]), np.array([1.0, -1.0, -2.0, -3.0]), graph)
    assert found.labels.tolist() == [0, 1, 1, -1] and found.areas.tolist() == [1.0, 2.0]
    assert found.peaks.tolist() == [0, 2]


def test_a_threshold_of_0_is_refused() -> None:
    with pytest.raises(ValueError, match="above 0"):
        clusters_beyond(np.ones(2), graph_of_edges(np.array([[0, 1]]), np.ones(2)), 0.0)
