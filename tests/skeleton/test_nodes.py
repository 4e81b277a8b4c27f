"""Where nodes stand, what arcs carry, and skeletons of meshes that come relabelled from bare files."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.mesh.shapes.strip import strip
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
