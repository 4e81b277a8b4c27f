"""Where nodes stand, what arcs carry, and skeletons of meshes that come relabelled from bare files."""

from __future__ import annotations

import networkx
import numpy as np
import pytest

from surfexp.io.reading import read_mesh
from surfexp.io.writing import write_mesh
from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.mesh.shapes.strip import strip, y_patch
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.agreement import topology
from surfexp.skeleton.branches import branch_graph, branch_paths
from surfexp.skeleton.export import write_skeleton
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.nearest_point import nearest_on_triangles
from surfexp.skeleton.polyline import trunk_contours
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import CONTOUR, JUNCTION
from surfexp.studies.callosum.callosum import callosum
from surfexp.studies.callosum.midline import midline_errors
from surfexp.studies.skeletons.skeleton_study import compactness, eigenmap_skeleton

JAGGED = strip(jag=0.5, arch=1.5, bend=1.2, seed=3).mesh


def relabelled(mesh: TriangleMesh, seed: int) -> TriangleMesh:
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(mesh.vertices))
    faces = np.argsort(order)[mesh.faces[rng.permutation(len(mesh.faces))]]
    return TriangleMesh(mesh.vertices[order], faces)


def from_bare_file(mesh: TriangleMesh, path) -> TriangleMesh:
    write_mesh(path, mesh)
    return TriangleMesh(*read_mesh(path)[:2])


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


@pytest.mark.parametrize("ending", [".off", ".ply", ".obj"])
def test_contours_of_each_level_agree_with_the_graph_on_relabelled_files(tmp_path, ending):
    mesh = from_bare_file(relabelled(y_patch().mesh, 1), tmp_path / f"y{ending}")
    first, values = eigenmap_skeleton(y_patch().mesh, levels="area_quantile", count=30)
    skeleton, values = eigenmap_skeleton(mesh, levels="area_quantile", count=30, persistence=0.0)
    assert topology(first)[0] == 3
    counted = []
    for level in skeleton.levels:
        # by components of the crossed faces, an independent route
        crossed = mesh.faces[(values[mesh.faces] >= level).any(axis=1) & (values[mesh.faces] < level).any(axis=1)]
        graph = networkx.Graph()
        for face in crossed.tolist():
            sides = [tuple(sorted((face[k], face[k - 1]))) for k in range(3)]
            networkx.add_path(
                graph, [side for side in sides if (values[side[0]] >= level) != (values[side[1]] >= level)]
            )
        counted.append(networkx.number_connected_components(graph))
    contours = level_contours(mesh, values, skeleton.levels)
    assert np.bincount(contours.level).tolist() == counted
    assert np.bincount(skeleton.level_index[skeleton.level_index >= 0]).tolist() == counted
    assert {1, 2} <= set(counted)


@pytest.mark.slow
def test_midlines_of_all_callosa_from_relabelled_bare_files(tmp_path):
    misses = []
    for seed in range(16):
        surface = callosum(seed)
        mesh = from_bare_file(relabelled(surface.mesh, seed), tmp_path / f"{seed}.ply")
        skeleton, _ = eigenmap_skeleton(mesh)
        assert skeleton.is_chain
        misses.append(midline_errors(surface.truth.midline, trunk_contours(skeleton))[0] / mesh.edge_length)
    assert np.mean(misses) <= 1.0


def test_resampled_shares_do_not_depend_on_where_the_points_were():
    surfaces = [strip(length=60.0 + 4.0 * i, arch=0.6 + 0.1 * i, bend=0.0, jag=0.0, seed=i).mesh for i in range(5)]
    shares = {}
    for levels in ("area_quantile", "arc_length"):
        found = {str(i): eigenmap_skeleton(mesh, levels=levels, count=40)[0] for i, mesh in enumerate(surfaces)}
        shares[levels] = [compactness(found, resample, draws=10).metrics["first_share"] for resample in (False, True)]
    assert abs(shares["area_quantile"][1] - shares["arc_length"][1]) < 2e-3
    line = trunk_contours(eigenmap_skeleton(surfaces[0], levels="uniform", count=40)[0])
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    assert steps.max() > 2.0 * steps.min()


def test_a_bare_line_file_opens_in_other_readers(tmp_path):
    skeleton, _ = eigenmap_skeleton(JAGGED, count=20)
    write_skeleton(tmp_path / "s.graphml", skeleton)
    assert networkx.is_connected(networkx.read_graphml(tmp_path / "s.graphml"))
