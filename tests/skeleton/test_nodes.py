"""Where nodes stand, what arcs carry, and skeletons of meshes that come relabelled from bare files."""

from __future__ import annotations

import networkx
import numpy as np
import pytest

from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.mesh.shapes.strip import strip
from surfexp.mesh.shapes.torus import torus
from surfexp.skeleton.branches import branch_graph, branch_paths
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.nearest_point import nearest_on_triangles
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import CONTOUR, JUNCTION

JAGGED = strip(jag=0.5, arch=1.5, bend=1.2, seed=3).mesh


def distance_to_surface(points, mesh):
    nearest = [
        np.linalg.norm(nearest_on_triangles(np.tile(p, (len(mesh.faces), 1)), mesh.vertices[mesh.faces]) - p, axis=1)
        for p in points
    ]
    return np.array([found.min() for found in nearest])


def test_the_nearest_point_of_a_triangle_beats_all_points_of_a_grid():
    rng = np.random.default_rng(0)
    corners, points = rng.normal(size=(60, 3, 3)), 2.0 * rng.normal(size=(60, 3))
    shares = np.array([(i, j, 60 - i - j) for i in range(61) for j in range(61 - i)]) / 60.0
    grid = np.linalg.norm(points[:, None] - np.einsum("gc,pcx->pgx", shares, corners), axis=2).min(axis=1)
    found = np.linalg.norm(points - nearest_on_triangles(points, corners), axis=1)
    assert (found <= grid + 1e-12).all() and (grid - found).max() < 0.1
    inside = np.einsum("pc,pcx->px", rng.dirichlet(np.ones(3), 60), corners)
    assert np.abs(nearest_on_triangles(inside, corners) - inside).max() < 1e-9
    flat = np.repeat(corners[:, :1], 3, axis=1)
    assert np.allclose(nearest_on_triangles(points, flat), flat[:, 0])


def test_junctions_of_open_contours_lie_on_the_surface():
    height = JAGGED.vertices[:, 2]
    skeleton = reeb_graph(JAGGED, height, choose_levels(JAGGED, height, 60, "uniform"))
    junctions = np.flatnonzero(skeleton.kinds == JUNCTION)
    assert len(junctions) >= 5
    assert distance_to_surface(skeleton.positions[junctions], JAGGED).max() < 1e-9
    means = []
    for node in junctions:
        around = skeleton.arcs[(skeleton.arcs == node).any(axis=1)].sum(axis=1) - node
        assert (skeleton.kinds[around] == CONTOUR).all()
        means.append(skeleton.positions[around].mean(axis=0))
    assert distance_to_surface(means, JAGGED).max() > 0.05 * JAGGED.edge_length


def test_junctions_of_closed_contours_stay_amid_their_centroids():
    mesh = genus_surface(2, 3000).mesh
    skeleton = reeb_graph(mesh, mesh.vertices[:, 0], np.linspace(-2, 2, 12))
    for node in np.flatnonzero(skeleton.kinds == JUNCTION):
        around = skeleton.arcs[(skeleton.arcs == node).any(axis=1)].sum(axis=1) - node
        assert np.allclose(skeleton.positions[node], skeleton.positions[around].mean(axis=0))


def test_arcs_between_forks_carry_their_polylines_and_widths():
    mesh = genus_surface(2, 3000).mesh
    skeleton = reeb_graph(mesh, mesh.vertices[:, 0] + 0.2 * mesh.vertices[:, 1], np.linspace(-2.2, 2.2, 30))
    graph = branch_graph(skeleton)
    assert (graph.number_of_nodes(), graph.number_of_edges()) == (6, 7)
    assert graph.number_of_edges() - graph.number_of_nodes() + 1 == skeleton.metrics["b1"] == 2
    total = sum(data["length"] for _, _, data in graph.edges(data=True))
    assert total == pytest.approx(sum(length for _, _, length in skeleton.graph().edges(data="length")))
    assert sum(len(path) - 1 for path in branch_paths(skeleton)) == len(skeleton.arcs)
    for a, b, data in graph.edges(data=True):
        assert np.array_equal(data["polyline"][0], graph.nodes[a]["position"])
        assert np.array_equal(data["polyline"][-1], graph.nodes[b]["position"])
        assert (data["widths"][1:-1] > 0).all() and len(data["widths"]) == len(data["values"]) == len(data["polyline"])


def test_a_ring_without_ends_is_one_arc():
    ring = torus(40, 16).mesh
    skeleton = reeb_graph(ring, ring.vertices[:, 0], np.linspace(-0.4, 0.4, 5))
    arcs = [arc for arc in skeleton.arcs if skeleton.degrees[arc].max() == 2]
    loop = type(skeleton)(**{**vars(skeleton), "arcs": np.array(arcs)})
    largest = max(networkx.connected_components(networkx.Graph(skeleton.arcs.tolist())), key=len)
    assert len(largest) == len(skeleton.positions)
    assert sum(len(path) - 1 for path in branch_paths(loop)) == len(arcs)
    triangle = type(skeleton)(**{**vars(skeleton), "arcs": np.array([[0, 1], [1, 2], [0, 2]])})
    (path,) = branch_paths(triangle)
    assert path[0] == path[-1] and len(path) == 4 and branch_graph(triangle).number_of_edges() == 1
