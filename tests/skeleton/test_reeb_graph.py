"""Reeb graphs against topology, the co-area formula, the exact graph and relabelled input."""

from __future__ import annotations

from itertools import pairwise

import networkx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.skeleton.contour_geometry import contour_lengths
from surfexp.skeleton.exact_reeb_graph import ReebGraph, exact_reeb_graph
from surfexp.skeleton.interlevel_components import slab_components
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.pruning import pruned
from surfexp.skeleton.published_reeb_graph import published_loops
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.simplification import simplified
from surfexp.skeleton.skeleton import arc_components

SURFACES = {
    0: icosphere(3).mesh,
    1: torus(36, 18).mesh,
    2: genus_surface(2, 3000).mesh,
    3: genus_surface(3, 4500).mesh,
}
PATCH = rectangle(31, 21).mesh


def contracted(graph: ReebGraph, levels: Floats) -> tuple[Integers, Integers]:
    """The sampled graph that an exact one contracts to: crossings of arcs with levels, and the pieces between them.

    Returns
    -------
    level : (N,) int64
        The level of each node, -1 for a piece of a slab.
    arcs : (A, 2) int64
        One between each crossing and the pieces below and above it: the graph of contours and all slab components.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    # a vertex at a level counts as above it
    slab = np.searchsorted(levels, graph.values, side="right")
    low, high = slab[graph.arcs[:, 0]], slab[graph.arcs[:, 1]]
    crossings = high - low
    first = np.concatenate([[0], np.cumsum(crossings + 1)])
    owner = np.repeat(np.arange(len(crossings)), crossings + 1)
    place = np.arange(first[-1]) - first[owner]
    count, nodes = int(first[-1]), len(graph.values)
    # an arc's first and last piece hang on its end nodes
    joins = [
        np.stack([first[:-1], count + graph.arcs[:, 0]], axis=1),
        np.stack([first[1:] - 1, count + graph.arcs[:, 1]], 1),
    ]
    pairs = np.concatenate(joins)
    matrix = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count + nodes, count + nodes))
    pieces, piece = connected_components(matrix, directed=False)
    crossed = np.flatnonzero(place < crossings[owner])
    level = np.concatenate([low[owner[crossed]] + place[crossed], np.full(pieces, -1)])
    number = np.arange(len(crossed))
    below = np.stack([len(crossed) + piece[crossed], number], axis=1)
    above = np.stack([number, len(crossed) + piece[crossed + 1]], axis=1)
    return level.astype(np.int64), np.concatenate([below, above]).astype(np.int64)


def smooth_function(mesh: TriangleMesh, seed: int, waves: int = 4):
    rng = np.random.default_rng(seed)
    frequencies, phases = rng.normal(size=(waves, 3)), rng.uniform(0, 6, waves)
    return np.cos(mesh.vertices @ frequencies.T + phases) @ rng.normal(size=waves)


def loops(graph):
    return len(graph.arcs) - len(graph.vertices) + arc_components(graph.arcs, len(graph.vertices))


def pieces_graph(level, arcs):
    graph = networkx.Graph()
    graph.add_nodes_from((i, {"level": int(k)}) for i, k in enumerate(level))
    graph.add_edges_from(arcs.tolist())
    return graph


@settings(max_examples=25)
@given(st.sampled_from(sorted(SURFACES)), st.integers(0, 10**6), st.integers(5, 80))
def test_loops_are_handles_on_random_surfaces_and_functions(genus, seed, count):
    mesh = SURFACES[genus]
    values = smooth_function(mesh, seed)
    exact = exact_reeb_graph(mesh, values)
    assert loops(exact) == genus == (2 - mesh.euler_characteristic) // 2
    assert loops(simplified(exact, 0.3 * float(np.ptp(values)))) == genus
    sampled = reeb_graph(mesh, values, choose_levels(mesh, values, count, "uniform"))
    assert sampled.metrics["b1"] + sampled.metrics["hidden_handles"] == genus
    assert 0 <= sampled.metrics["b1"] <= genus


@settings(max_examples=15)
@given(st.sampled_from([*sorted(SURFACES), "patch"]), st.integers(0, 10**6), st.integers(3, 25), st.booleans())
def test_the_sampled_graph_is_a_contraction_of_the_exact_one(which, seed, count, noisy):
    mesh = PATCH if which == "patch" else SURFACES[which]
    values = smooth_function(mesh, seed)
    if noisy:
        # ties in plenty
        values = np.round(values + np.random.default_rng(seed).normal(size=len(values)), 1)
    levels = choose_levels(mesh, values, count, "uniform")
    contours = level_contours(mesh, values, levels)
    slabs = slab_components(mesh, contours)
    number = np.arange(len(contours.level))
    ours_level = np.concatenate([contours.level, np.full(slabs.count, -1)])
    ours_arcs = np.concatenate(
        [np.stack([len(number) + slabs.below, number], 1), np.stack([len(number) + slabs.above, number], 1)]
    )
    level, arcs = contracted(exact_reeb_graph(mesh, values), levels)
    first, second = pieces_graph(ours_level, ours_arcs), pieces_graph(level, arcs)
    assert np.array_equal(np.sort(ours_level), np.sort(level))
    assert networkx.weisfeiler_lehman_graph_hash(
        first, node_attr="level", iterations=12
    ) == networkx.weisfeiler_lehman_graph_hash(second, node_attr="level", iterations=12)
    if len(level) < 200:
        assert networkx.is_isomorphic(first, second, node_match=lambda a, b: a["level"] == b["level"])


@pytest.mark.parametrize("mesh", [SURFACES[0], SURFACES[2], PATCH], ids=["sphere", "double torus", "patch"])
def test_lengths_of_contours_integrate_to_the_total_variation(mesh):
    values = smooth_function(mesh, 3)
    exact = total_variation(fem(mesh), values)
    errors = []
    for count in (200, 800):
        edges = np.linspace(values.min(), values.max(), count + 1)
        middles = 0.5 * (edges[1:] + edges[:-1])
        contours = level_contours(mesh, values, middles)
        errors.append(abs(contour_lengths(contours, mesh.vertices).sum() * (edges[1] - edges[0]) / exact - 1.0))
    assert errors[1] < 2e-4 and errors[1] < errors[0]


def test_a_circle_of_latitude_has_its_centroid_on_the_axis_and_its_length():
    mesh = icosphere(5).mesh
    skeleton = reeb_graph(mesh, mesh.vertices[:, 2], np.linspace(-1, 1, 22)[1:-1])
    assert skeleton.is_chain and skeleton.closed[skeleton.level_index >= 0].all()
    on_levels = skeleton.level_index >= 0
    exact = 2 * np.pi * np.sqrt(1.0 - skeleton.values[on_levels] ** 2)
    assert np.abs(skeleton.lengths[on_levels] / exact - 1.0).max() < 2e-3
    assert np.abs(skeleton.positions[on_levels][:, :2]).max() < 2e-3
    assert np.abs(skeleton.positions[on_levels][:, 2] - skeleton.values[on_levels]).max() < 1e-12


def test_relabelling_rotation_and_orientation_change_nothing():
    mesh = SURFACES[2]
    values = smooth_function(mesh, 11)
    levels = choose_levels(mesh, values, 20, "arc_length")
    first = reeb_graph(mesh, values, levels)
    rng = np.random.default_rng(0)
    order = rng.permutation(len(values))
    place = np.argsort(order)
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    faces = place[mesh.faces[rng.permutation(len(mesh.faces))]]
    faces = np.where(rng.random(len(faces))[:, None] < 0.5, faces[:, [1, 2, 0]], faces[:, ::-1])
    turned = TriangleMesh(mesh.vertices[order] @ rotation.T, faces)
    second = reeb_graph(turned, values[order], levels)
    # vertex_areas and lengths are sums in another order, hence the tolerance
    again = choose_levels(turned, values[order], 20, "arc_length")
    assert np.abs(again - levels).max() < 1e-9 * np.ptp(values)
    assert first.metrics == second.metrics
    assert networkx.is_isomorphic(
        first.graph(),
        second.graph(),
        node_match=lambda a, b: a["kind"] == b["kind"] and abs(a["length"] - b["length"]) < 1e-9,
    )
    key = np.lexsort(np.round(first.positions @ rotation.T, 6).T)
    assert (
        np.abs(
            (first.positions @ rotation.T)[key] - second.positions[np.lexsort(np.round(second.positions, 6).T)]
        ).max()
        < 1e-6
    )


def test_levels_through_vertices_and_flat_regions():
    mesh = rectangle(21, 11, 2.0, 1.0).mesh
    x = mesh.vertices[:, 0]
    through = reeb_graph(mesh, x, np.unique(x)[3:9])
    assert through.is_chain and np.allclose(through.lengths[:6], 1.0)
    flat = np.clip(x, 0.5, 1.5)
    skeleton = reeb_graph(mesh, flat, np.array([0.6, 1.0, 1.5]))
    assert skeleton.is_chain and np.allclose(skeleton.lengths[:3], 1.0)


def test_components_and_holes_are_counted():
    one = icosphere(2).mesh
    two = TriangleMesh(
        np.concatenate([one.vertices, one.vertices + np.array([3.0, 0.0, 0.5])]),
        np.concatenate([one.faces, one.faces + len(one.vertices)]),
    )
    skeleton = reeb_graph(two, two.vertices[:, 2], np.array([-0.9, 0.0, 0.7]))
    assert skeleton.metrics["components"] == 2 and skeleton.metrics["b1"] == 0 and not skeleton.is_chain
    ring = torus(30, 14).mesh
    annulus = TriangleMesh(ring.vertices, ring.faces[ring.vertices[ring.faces][:, :, 2].mean(axis=1) > 0.05])
    values = annulus.vertices[:, 0]
    found = reeb_graph(annulus, values, np.linspace(-1.2, 1.2, 12))
    assert found.metrics["b1"] == 1 and "hidden_handles" not in found.metrics


@pytest.mark.parametrize(
    ("values", "levels", "message"),
    [
        (np.zeros(651), [0.5], "no level sets"),
        (np.full(651, np.nan), [0.5], "not finite"),
        (np.zeros(7), [0.5], "the mesh has 651 vertices"),
        (np.arange(651.0), [2.0, 1.0], "increase"),
        (np.arange(651.0), [], "at least 1"),
    ],
)
def test_unfit_input_is_refused(values, levels, message):
    with pytest.raises(ValueError, match=message):
        reeb_graph(PATCH, values, np.array(levels))


def test_an_edge_with_three_faces_is_refused():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1.0]])
    mesh = TriangleMesh(vertices, np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]]))
    with pytest.raises(ValueError, match="has 3 faces, at most 2"):
        reeb_graph(mesh, vertices[:, 0] + 0.1 * vertices[:, 1], np.array([0.5]))


def test_simplification_cuts_noise_and_keeps_what_is_large():
    mesh = SURFACES[2]
    height = mesh.vertices[:, 0] + 0.2 * mesh.vertices[:, 1]
    clean = simplified(exact_reeb_graph(mesh, height), 0.2)
    noisy = exact_reeb_graph(mesh, height + 0.08 * np.random.default_rng(0).uniform(-1, 1, len(height)))
    assert len(noisy.vertices) > 10 * len(clean.vertices)
    mended = simplified(noisy, 0.2)
    assert networkx.is_isomorphic(networkx.MultiGraph(clean.arcs.tolist()), networkx.MultiGraph(mended.arcs.tolist()))
    assert np.abs(np.sort(clean.values) - np.sort(mended.values)).max() < 0.2
    with pytest.raises(ValueError, match="at least 0"):
        simplified(noisy, -1.0)


def contours_of(graph):
    return [graph.contour_points[start:stop] for start, stop in pairwise(graph.contour_starts)]


def test_pruning_cuts_teeth_and_neither_loops_nor_ends():
    mesh = SURFACES[2]
    height = mesh.vertices[:, 0] + 0.2 * mesh.vertices[:, 1]
    levels = choose_levels(mesh, height, 60, "uniform")
    clean = reeb_graph(mesh, height, levels)
    rough = reeb_graph(mesh, height + 0.08 * np.random.default_rng(0).uniform(-1, 1, len(height)), levels)
    mended = pruned(rough, 0.1)
    assert rough.metrics["leaves"] > 20 and mended.metrics["leaves"] == clean.metrics["leaves"] == 2
    assert mended.metrics["b1"] == rough.metrics["b1"] == 2 and mended.metrics["components"] == 1
    assert mended.contour_starts[-1] == len(mended.contour_points) < len(rough.contour_points)
    assert mended.metrics["cut_branches"] >= rough.metrics["leaves"] - 2
    before, after = (
        {tuple(graph.positions[k]): points for k, points in enumerate(contours_of(graph))} for graph in (rough, mended)
    )
    assert all(np.array_equal(points, before[node]) for node, points in after.items())
    assert pruned(clean, 1.0).metrics["b1"] == 2
    with pytest.raises(ValueError, match=r"0\.\.1"):
        pruned(clean, -0.1)


def test_the_published_rule_is_right_on_chains_and_loses_handles_at_the_ends():
    sphere = SURFACES[0]
    assert published_loops(sphere, sphere.vertices[:, 2], np.linspace(-0.9, 0.9, 9)) == 0
    ring = torus(60, 24).mesh
    along = ring.vertices[:, 0]
    # the inner saddles at -0.6 and 0.6 bound the loop: levels inside them alone see two arcs and no loop
    assert reeb_graph(ring, along, np.array([-0.4, 0.0, 0.4])).metrics["b1"] == 1
    assert published_loops(ring, along, np.array([-0.4, 0.0, 0.4])) == 0
    assert published_loops(ring, along, np.linspace(-1.3, 1.3, 20)) == 1
