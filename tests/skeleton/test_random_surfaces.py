"""Reeb graphs of closed surfaces whose genus nobody planned."""

from __future__ import annotations

import networkx
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter
from skimage.measure import marching_cubes

from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.hidden_handles import hidden_handles
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import arc_components


def random_closed_surface(seed: int) -> TriangleMesh:
    """The boundary of where smooth noise in a box is positive: several pieces with handles of any number."""
    rng = np.random.default_rng(seed)
    noise = gaussian_filter(rng.normal(size=(14, 14, 14)), 1.6)
    field = np.full((18, 18, 18), -noise.std())
    field[2:-2, 2:-2, 2:-2] = noise
    field = gaussian_filter(field, 0.5)
    vertices, faces, _, _ = marching_cubes(field, 0.0, allow_degenerate=False)
    return TriangleMesh(vertices.astype(np.float64), faces.astype(np.int64))


def smooth_function(mesh: TriangleMesh, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.cos(mesh.vertices @ rng.normal(scale=0.25, size=(3, 4)) + rng.uniform(0, 6, 4)) @ rng.normal(size=4)


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.integers(5, 60), st.sampled_from(["uniform", "area_quantile", "arc_length"]))
def test_loops_are_the_handles_of_the_euler_characteristic(seed, count, choice):
    mesh = random_closed_surface(seed)
    assert mesh.is_closed
    handles = mesh.component_count - mesh.euler_characteristic // 2
    values = smooth_function(mesh, seed)
    exact = exact_reeb_graph(mesh, values)
    assert len(exact.arcs) - len(exact.vertices) + arc_components(exact.arcs, len(exact.vertices)) == handles
    levels = choose_levels(mesh, values, count, choice)
    sampled = reeb_graph(mesh, values, levels)
    hidden = hidden_handles(mesh, values, levels)
    assert sampled.metrics["components"] == mesh.component_count
    assert sampled.metrics["b1"] + sum(item.handles for item in hidden) == handles
    assert sampled.metrics["hidden_handles"] == sum(item.handles for item in hidden)
    for item in hidden:
        # a loop begins where a contour splits and ends where two meet
        low, high = np.searchsorted(exact.values, [item.low, item.high])
        assert item.handles >= 1 and item.low < item.high
        assert (exact.arcs[:, 0] == low).sum() >= 2 and (exact.arcs[:, 1] == high).sum() >= 2
        assert np.searchsorted(levels, [item.low, item.high], side="right").tolist() == [item.slab] * 2


def test_the_surfaces_do_have_many_handles_and_pieces():
    meshes = [random_closed_surface(seed) for seed in range(12)]
    handles = [mesh.component_count - mesh.euler_characteristic // 2 for mesh in meshes]
    assert len(set(handles)) >= 4 and max(handles) >= 5 and max(mesh.component_count for mesh in meshes) >= 2


def test_a_note_names_the_saddles_that_no_level_separates():
    mesh = random_closed_surface(3)
    values = mesh.vertices[:, 2]
    skeleton = reeb_graph(mesh, values, np.array([2.5, 6.0, 14.0]))
    hidden = hidden_handles(mesh, values, np.array([2.5, 6.0, 14.0]))
    assert hidden and "critical levels" in skeleton.notes[0] and str(hidden[0]) in skeleton.notes[0]
    assert hidden_handles(mesh, values, np.sort(np.unique(values))[1:]) == ()


def test_critical_levels_hide_no_handle():
    for seed in range(8):
        mesh = random_closed_surface(seed)
        values = smooth_function(mesh, seed)
        critical = np.unique(exact_reeb_graph(mesh, values).values)
        skeleton = reeb_graph(mesh, values, choose_levels(mesh, values, 2 * len(critical), "critical"))
        assert skeleton.metrics["hidden_handles"] == 0


def test_levels_between_all_critical_values_give_the_exact_graph():
    mesh = random_closed_surface(5)
    values = smooth_function(mesh, 5)
    exact = exact_reeb_graph(mesh, values)
    skeleton = reeb_graph(mesh, values, 0.5 * (exact.values[1:] + exact.values[:-1]))
    degrees = np.bincount(exact.arcs.ravel())
    found = networkx.Graph(skeleton.arcs.tolist())
    forks = sorted(degree for _, degree in found.degree() if degree != 2)
    assert forks == sorted(degrees[degrees != 2].tolist())


@settings(max_examples=10)
@given(st.integers(0, 10**6))
def test_every_vertex_lies_on_an_arc_whose_values_hold_its_own(seed):
    mesh = random_closed_surface(seed)
    lonely = TriangleMesh(np.vstack([mesh.vertices, [[0.0, 0.0, 0.0]]]), mesh.faces)
    values = smooth_function(lonely, seed)
    graph = exact_reeb_graph(lonely, values)
    assert graph.vertex_arcs[-1] == -1 and (graph.vertex_arcs[:-1] >= 0).all()
    ends = graph.values[graph.arcs[graph.vertex_arcs[:-1]]]
    assert (ends[:, 0] <= values[:-1]).all() and (values[:-1] <= ends[:, 1]).all()
