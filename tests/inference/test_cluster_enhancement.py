"""Threshold-free enhancement against its definition, step sums that converge to it, and what it does not depend on."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference import enhanced_by_definition, enhanced_by_steps, maps_with_ties, meshes

from surfexp.inference.cluster_enhancement import enhanced
from surfexp.inference.vertex_graph import graph_of_edges, vertex_graph
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

BALL = icosphere(levels=3).mesh
GRAPH = vertex_graph(BALL)
POWERS = st.sampled_from([(1.0, 2.0), (0.5, 2.0), (0.0, 1.0), (0.7, 0.0), (2.0, 0.5)])


def smooth_map(seed: int = 0) -> np.ndarray:
    directions = np.random.default_rng(seed).standard_normal((3, 12))
    return np.asarray(np.sin(2.0 * BALL.vertices @ directions).sum(axis=1))


def compare_with_definition(data: st.DataObject, mesh: TriangleMesh, powers: tuple[float, float]) -> None:
    values = data.draw(maps_with_ties(len(mesh.vertices)))
    areas = mesh.vertex_areas + 0.1
    found = enhanced(values, graph_of_edges(mesh.edges, areas), extent_power=powers[0], height_power=powers[1])
    np.testing.assert_allclose(
        found, enhanced_by_definition(values, mesh.edges, areas, *powers), rtol=1e-10, atol=1e-12
    )


@settings(max_examples=100, deadline=None)
@given(st.data(), meshes(), POWERS)
def test_it_is_its_definition(data: st.DataObject, mesh: TriangleMesh, powers: tuple[float, float]) -> None:
    compare_with_definition(data, mesh, powers)


@pytest.mark.slow
@settings(max_examples=1000, deadline=None)
@given(st.data(), meshes(), POWERS)
def test_it_is_its_definition_on_many_meshes(
    data: st.DataObject, mesh: TriangleMesh, powers: tuple[float, float]
) -> None:
    compare_with_definition(data, mesh, powers)


def test_a_path_by_hand() -> None:
    """Values 2, 1, 3, 0, -1 along a path of unit areas, E = 1, H = 1: integrals of a(h) h by hand."""
    graph = graph_of_edges(np.array([[0, 1], [1, 2], [2, 3], [3, 4]]), np.ones(5))
    found = enhanced(np.array([2.0, 1.0, 3.0, 0.0, -1.0]), graph, height_power=1.0)
    np.testing.assert_allclose(found, [1.5 + 1.5, 1.5, 1.5 + 4.0, 0.0, -0.5], atol=1e-15)


def test_step_sums_come_to_it_by_the_first_order_of_their_step() -> None:
    values = smooth_map()
    exact = enhanced(values, GRAPH, extent_power=0.5)
    errors = []
    for step in (0.4, 0.2, 0.1, 0.05, 0.025):
        summed = enhanced_by_steps(values, BALL.edges, BALL.vertex_areas, 0.5, 2.0, step)
        np.testing.assert_allclose(enhanced(values, GRAPH, extent_power=0.5, step=step), summed, rtol=1e-9, atol=1e-12)
        errors.append(np.abs(summed - exact).max() / np.abs(exact).max())
    assert errors[0] > 0.02 and errors[-1] < 0.01
    rate = np.polyfit(np.log([0.4, 0.2, 0.1, 0.05, 0.025]), np.log(errors), 1)[0]
    assert 0.8 < rate < 1.2


@settings(max_examples=60, deadline=None)
@given(st.data(), meshes(), POWERS, st.sampled_from([0.5, 0.3, 4.0]))
def test_a_sum_over_steps_is_its_definition(
    data: st.DataObject, mesh: TriangleMesh, powers: tuple[float, float], step: float
) -> None:
    """Also where values lie on steps."""
    values = np.nan_to_num(data.draw(maps_with_ties(len(mesh.vertices))))
    areas = mesh.vertex_areas + 0.1
    graph = graph_of_edges(mesh.edges, areas)
    found = enhanced(values, graph, extent_power=powers[0], height_power=powers[1], step=step)
    wanted = enhanced_by_steps(values, mesh.edges, areas, *powers, step)
    np.testing.assert_allclose(found, wanted, rtol=1e-10, atol=1e-12)


def test_a_step_of_0_is_refused() -> None:
    with pytest.raises(ValueError, match="above 0"):
        enhanced(np.ones(642), GRAPH, step=0.0)


@pytest.mark.parametrize(("extent", "height"), [(1.0, 2.0), (0.5, 2.0)])
def test_it_scales_with_the_map_and_with_the_areas(extent: float, height: float) -> None:
    values, powers = smooth_map(), {"extent_power": extent, "height_power": height}
    exact = enhanced(values, GRAPH, **powers)
    np.testing.assert_allclose(enhanced(3.0 * values, GRAPH, **powers), 3.0 ** (height + 1.0) * exact, rtol=1e-12)
    larger = graph_of_edges(BALL.edges, 7.0 * GRAPH.areas)
    np.testing.assert_allclose(enhanced(values, larger, **powers), 7.0**extent * exact, rtol=1e-12)
    np.testing.assert_allclose(enhanced(-values, GRAPH, **powers), -exact, rtol=1e-12)


def test_it_does_not_depend_on_the_numbers_of_vertices() -> None:
    values, order = np.round(smooth_map(), 1), np.random.default_rng(0).permutation(len(BALL.vertices))
    place = np.argsort(order)
    renumbered = vertex_graph(TriangleMesh(BALL.vertices[order], place[BALL.faces]))
    np.testing.assert_allclose(enhanced(values[order], renumbered), enhanced(values, GRAPH)[order], rtol=1e-10)


def test_it_grows_with_the_map_and_one_side_is_the_positive_half_of_both() -> None:
    values = smooth_map()
    assert (enhanced(np.abs(values) + 0.3, GRAPH) >= enhanced(np.abs(values), GRAPH)).all()
    one, both = enhanced(values, GRAPH, two_sided=False), enhanced(values, GRAPH)
    np.testing.assert_allclose(one, np.maximum(both, 0.0), rtol=1e-12)
