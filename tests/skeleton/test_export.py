"""Skeletons written to files and read back by other readers."""

from __future__ import annotations

import networkx
import numpy as np
import pytest

from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.skeleton.export import write_skeleton
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import Skeleton


@pytest.fixture(scope="module")
def skeleton() -> Skeleton:
    mesh = genus_surface(2, 3000).mesh
    return reeb_graph(mesh, mesh.vertices[:, 0] + 0.2 * mesh.vertices[:, 1], np.linspace(-2.2, 2.2, 12))


def test_graphml_keeps_the_graph_and_its_attributes(tmp_path, skeleton):
    write_skeleton(tmp_path / "s.graphml", skeleton)
    read = networkx.read_graphml(tmp_path / "s.graphml", node_type=int)
    assert networkx.utils.graphs_equal(networkx.Graph(read.edges), networkx.Graph(skeleton.graph().edges))
    found = np.array([[read.nodes[i][axis] for axis in "xyz"] for i in range(len(skeleton.positions))])
    assert np.array_equal(found, skeleton.positions)
    assert read.number_of_edges() - read.number_of_nodes() + 1 == 2
    assert {read.nodes[i]["kind"] for i in read} == {"contour", "cap", "junction"}


@pytest.mark.parametrize(("name", "points", "arcs"), [("s.vtk", "POINTS", "LINES"), ("s.ply", "end_header", None)])
def test_lines_for_viewers(tmp_path, name, points, arcs, skeleton):
    write_skeleton(tmp_path / name, skeleton)
    lines = (tmp_path / name).read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(points)) + 1
    found = np.array([line.split() for line in lines[start : start + len(skeleton.positions)]], dtype=float)
    assert np.allclose(found, skeleton.positions, atol=1e-8)
    after = start + len(skeleton.positions) + (1 if arcs else 0)
    pairs = np.array([line.split()[-2:] for line in lines[after : after + len(skeleton.arcs)]], dtype=int)
    assert np.array_equal(pairs, skeleton.arcs)


def test_a_viewer_gets_values_and_lengths_at_the_nodes(tmp_path, skeleton):
    write_skeleton(tmp_path / "s.vtk", skeleton)
    lines, count = (tmp_path / "s.vtk").read_text().splitlines(), len(skeleton.positions)
    for name, values in (("value", skeleton.values), ("length", skeleton.lengths)):
        start = lines.index(f"SCALARS {name} double 1") + 2
        assert np.allclose(np.array(lines[start : start + count], dtype=float), values, atol=1e-8)


def test_another_ending_is_refused(tmp_path, skeleton):
    with pytest.raises(ValueError, match=r"graphml, \.swc, \.vtk, \.ply"):
        write_skeleton(tmp_path / "s.obj", skeleton)
