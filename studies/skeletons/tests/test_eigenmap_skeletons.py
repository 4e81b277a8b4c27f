"""Skeletons of eigenmaps: contours against the graph, midlines of callosa, shares of variance, files."""

from __future__ import annotations

import networkx
import numpy as np
import pytest

from surfexp.io.reading import read_mesh
from surfexp.io.writing import write_mesh
from surfexp.mesh.shapes.strip import strip, y_patch
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.export import write_skeleton
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.polyline import trunk_contours
from surfexp_studies.skeletons.agreement import topology
from surfexp_studies.skeletons.callosum import callosum
from surfexp_studies.skeletons.midline import midline_errors
from surfexp_studies.skeletons.skeleton_study import compactness, eigenmap_skeleton

JAGGED = strip(jag=0.5, arch=1.5, bend=1.2, seed=3).mesh


def relabelled(mesh: TriangleMesh, seed: int) -> TriangleMesh:
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(mesh.vertices))
    faces = np.argsort(order)[mesh.faces[rng.permutation(len(mesh.faces))]]
    return TriangleMesh(mesh.vertices[order], faces)


def from_bare_file(mesh: TriangleMesh, path) -> TriangleMesh:
    write_mesh(path, mesh)
    return TriangleMesh(*read_mesh(path)[:2])


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
