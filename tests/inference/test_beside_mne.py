"""Threshold-free enhancement beside mne's sum over steps, which counts vertices where areas are taken here."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_array

from surfexp.inference.cluster_enhancement import enhanced
from surfexp.inference.linear_model import contrast_model
from surfexp.inference.rearrangements import unchanged
from surfexp.inference.vertex_graph import graph_of_edges
from surfexp.mesh.shapes.icosphere import icosphere


@pytest.mark.optional
def test_the_map_of_mne_comes_to_the_exact_one_as_its_step_falls() -> None:
    stats = pytest.importorskip("mne.stats")
    ball = icosphere(levels=3).mesh
    n = len(ball.vertices)
    waves = np.sin(3.0 * ball.vertices @ np.random.default_rng(0).standard_normal((3, 12))).T
    data = waves + 0.3 * np.random.default_rng(1).standard_normal((12, n))
    graph = graph_of_edges(ball.edges, np.ones(n))
    t = contrast_model(data, np.ones((12, 1)), np.ones(1)).t_maps(unchanged(12))[0]
    exact = enhanced(t, graph, extent_power=0.5)
    adjacency = csr_array((np.ones(len(graph.neighbours)), graph.neighbours, graph.starts), shape=(n, n))
    errors = []
    for step in (0.4, 0.2, 0.1, 0.05):
        found = stats.permutation_cluster_1samp_test(
            data,
            threshold={"start": 0, "step": step},
            n_permutations=2,
            adjacency=adjacency,
            out_type="mask",
            seed=0,
            verbose="error",
        )
        errors.append(np.abs(found[0] - exact).max() / np.abs(exact).max())
    assert errors == sorted(errors, reverse=True) and errors[0] > 0.05 and errors[-1] < 0.02
