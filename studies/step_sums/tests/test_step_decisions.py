"""Decisions by steps: by hand, and on data sets whose effect is plain."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.inference.cluster_enhancement import enhanced
from surfexp.inference.corrections import family_wise
from surfexp.inference.linear_model import contrast_model
from surfexp.inference.rearrangements import sign_flips
from surfexp.inference.vertex_graph import vertex_graph
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp_studies.step_sums.step_decisions import METHODS, Effect, disagreements, named_vertices, step_decisions

BALL = icosphere(levels=2).mesh
FIELDS = np.random.default_rng(0).standard_normal((162, 40))


def test_disagreement_by_hand() -> None:
    named = np.array([[1, 1, 1, 0, 0], [1, 1, 1, 0, 0], [0, 1, 1, 1, 0], [0, 0, 0, 0, 0]], dtype=bool)
    np.testing.assert_allclose(disagreements(named), [0.0, 0.0, 0.5, 1.0])
    assert np.isnan(disagreements(np.zeros((2, 5), dtype=bool))).all()


def test_named_vertices_are_those_of_each_method_alone() -> None:
    data = FIELDS[:, :8].T + 1.5 * (BALL.vertices[:, 2] > 0.3)
    model, graph = contrast_model(data, np.ones((8, 1)), np.ones(1)), vertex_graph(BALL)
    flips = sign_flips(np.arange(8), 256, np.random.default_rng(0))
    named = named_vertices(model, flips, graph)
    maps = model.t_maps(flips)
    observed = maps[int(np.flatnonzero((flips.signs == 1.0).all(axis=1))[0])]
    for row, step in ((0, None), (1, 0.1), (3, 0.5), (5, 0.05)):

        def raised(t: np.ndarray, row: int = row, step: float | None = step) -> np.ndarray:
            return np.abs(enhanced(t, graph, step=step * np.abs(t).max() if METHODS[row] == "twentieth" else step))

        wanted = family_wise(raised(observed), np.array([raised(t).max() for t in maps])) <= 0.05
        np.testing.assert_array_equal(named[row], wanted)
    assert 0 < named[0].sum() < 162 and METHODS[5] == "twentieth"


def test_a_plain_effect_is_found_by_all_and_nothing_without_one() -> None:
    found = step_decisions(BALL, FIELDS, Effect(maps=10, radius=0.8, height=4.0, flips=100))
    assert found.metrics["sets"] == 4 and all(found.metrics[f"power {method}"] == 100.0 for method in METHODS)
    assert found.metrics["disagreement exact"] == 0.0 == found.metrics["power_lost step_5"]
    none = step_decisions(BALL, FIELDS, Effect(maps=10, flips=100))
    assert none.metrics["rejections exact"] <= 50.0 and "power exact" not in none.metrics
    share, low, high = none.columns["rejections"][3]
    assert none.metrics["level_held step_5"] == float(low <= 5.0 <= high) and low <= share <= high


def test_fields_that_are_no_whole_number_of_sets_are_refused() -> None:
    with pytest.raises(ValueError, match="no whole number of sets of 16"):
        step_decisions(BALL, FIELDS, Effect())
    with pytest.raises(ValueError, match="1 fields are no whole number"):
        step_decisions(BALL, FIELDS[:, 0], Effect())
