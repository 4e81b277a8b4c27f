"""Skeletons written to files and read back by other readers."""

from __future__ import annotations

import networkx
import numpy as np
import pytest

from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.skeleton.export import write_skeleton
from surfexp.skeleton.reeb_graph import reeb_graph

MESH = genus_surface(2, 3000).mesh
SKELETON = reeb_graph(MESH, MESH.vertices[:, 0] + 0.2 * MESH.vertices[:, 1], np.linspace(-2.2, 2.2, 12))


def test_graphml_keeps_the_graph_and_its_attributes(tmp_path):
    write_skeleton(tmp_path / "s.graphml", SKELETON)
    read = networkx.read_graphml(tmp_path / "s.graphml", node_type=int)
    assert networkx.utils.graphs_equal(networkx.Graph(read.edges), networkx.Graph(SKELETON.graph().edges))
    found = np.array([[read.nodes[i][axis] for axis in "xyz"] for i in range(len(SKELETON.positions))])
    assert np.array_equal(found, SKELETON.positions)
    assert read.number_of_edges() - read.number_of_nodes() + 1 == 2
    assert {read.nodes[i]["kind"] for i in read} == {"contour", "cap", "junction"}


@pytest.mark.parametrize(("name", "points", "arcs"), [("s.vtk", "POINTS", "LINES"), ("s.ply", "end_header", None)])
def test_lines_for_viewers(tmp_path, name, points, arcs):
    write_skeleton(tmp_path / name, SKELETON)
    lines = (tmp_path / name).read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(points)) + 1
    found = np.array([line.split() for line in lines[start : start + len(SKELETON.positions)]], dtype=float)
    assert np.allclose(found, SKELETON.positions, atol=1e-8)
    after = start + len(SKELETON.positions) + (1 if arcs else 0)
    pairs = np.array([line.split()[-2:] for line in lines[after : after + len(SKELETON.arcs)]], dtype=int)
    assert np.array_equal(pairs, SKELETON.arcs)


def test_a_viewer_gets_values_and_lengths_at_the_nodes(tmp_path):
    write_skeleton(tmp_path / "s.vtk", SKELETON)
    lines, count = (tmp_path / "s.vtk").read_text().splitlines(), len(SKELETON.positions)
    for name, values in (("value", SKELETON.values), ("length", SKELETON.lengths)):
        start = lines.index(f"SCALARS {name} double 1") + 2
        assert np.allclose(np.array(lines[start : start + count], dtype=float), values, atol=1e-8)


def test_another_ending_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"graphml, \.vtk, \.ply"):
        write_skeleton(tmp_path / "s.obj", SKELETON)
