"""The Reeb graph of a surface with a boundary: its loops are all counted, those between two levels too."""

from __future__ import annotations

import numpy as np
import pytest

import surfexp as sx
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.tasks.part_of_task import part_for


@pytest.mark.parametrize("count", [1, 2, 3, 5, 9, 20])
@pytest.mark.parametrize("height", [-1.3, -0.9, 0.0])
def test_loops_of_an_open_surface_are_those_of_the_exact_graph(height: float, count: int) -> None:
    torus = sx.shape("torus", n_u=40, n_v=20)
    slanted = torus.vertices @ np.array([0.8, 0.1, 0.6])
    opened = sx.Surface(torus.mesh, mask=torus.vertices[:, 1] > height)
    part = part_for(opened)
    exact = exact_reeb_graph(part.mesh, part.restrict(slanted))
    loops = len(exact.arcs) - len(exact.vertices) + part.mesh.component_count
    for levels in ("uniform", "arc_length"):
        found = sx.reeb_graph(opened, slanted, count=count, levels=levels)
        assert found.metrics["b1"] + found.metrics["hidden_handles"] == loops
        assert any("critical levels" in note for note in found.notes) == (found.metrics["hidden_handles"] > 0)
    assert loops or height == 0.0


def test_a_distance_takes_graphs_and_no_surfaces() -> None:
    torus = sx.shape("torus", n_u=20, n_v=10)
    with pytest.raises(TypeError, match=r"reeb_distance takes results of sx.reeb_graph, not Surface"):
        sx.reeb_distance(torus, torus)
    graph = sx.reeb_graph(torus, torus.vertices[:, 0])
    with pytest.raises(TypeError, match=r"check_reeb_distance takes a result of sx.reeb_distance, not Skeleton"):
        sx.check_reeb_distance(graph, graph, graph)
