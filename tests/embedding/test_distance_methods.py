"""A name stands for its method: each is compared with the function behind it, on clouds small enough to try all."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from embedded_clouds import cloud

from surfexp.embedding.distance_methods import Pairing
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.sup_inf import block_group, sup_inf_distance
from surfexp.embedding.wasserstein import WassersteinObjective, transport_cost, wasserstein_distance

FIRST, SECOND = cloud(3, 40, 1), cloud(3, 36, 2)
SAMPLES = 100  # more than there are points


def test_matrices_of_blocks_are_orthogonal_and_keep_the_blocks() -> None:
    blocks = ((0, 1), (1, 3), (3, 6))
    matrices = block_group(blocks, angles=5)
    assert len(matrices) == 2 * 10 * 6
    outside = np.ones((6, 6), dtype=bool)
    for start, stop in blocks:
        outside[start:stop, start:stop] = False
    for matrix in matrices:
        assert np.abs(matrix @ matrix.T - np.eye(6)).max() < 1e-12 and not matrix[outside].any()
    planes = {tuple(np.round(matrix[1:3, 1:3].ravel(), 9)) for matrix in matrices}
    assert len(planes) == 10


@pytest.mark.parametrize(("method", "inside"), [("sup_inf", "largest"), ("sup_inf_mean", "mean")])
def test_sup_inf_has_its_own_distance_inside(method: str, inside: str) -> None:
    few = FIRST.sample(SAMPLES, 0), SECOND.sample(SAMPLES, 0)
    own = [eigenvalue_blocks(embedding.values, gap=0.03) for embedding in (FIRST, SECOND)]
    expected = {name: sup_inf_distance(*few, own[0], own[1], name, 24, 0) for name in ("mean", "largest")}
    assert expected["mean"] < expected["largest"]
    found = Pairing(method, samples=SAMPLES)(FIRST, SECOND)  # type: ignore[arg-type]
    assert found == (pytest.approx(expected[inside], rel=1e-12), 0.0)


@pytest.mark.parametrize(("method", "summary"), [("mean_hausdorff", "mean"), ("hausdorff", "largest")])
def test_distances_over_signs_come_with_their_bound(method: str, summary: str) -> None:
    found = Pairing(method, samples=SAMPLES)(FIRST, SECOND)  # type: ignore[arg-type]
    expected = spectral_distance(FIRST, SECOND, summary=summary, samples=SAMPLES)  # type: ignore[arg-type]
    assert found == (expected.value, expected.lower_bound)


def test_transport_comes_with_its_bound() -> None:
    expected = wasserstein_distance(FIRST, SECOND, SAMPLES, 2000, 0)
    assert Pairing("wasserstein", samples=SAMPLES)(FIRST, SECOND) == (expected.value, expected.lower_bound)


def test_transport_under_signs_and_its_bound_where_they_are_undecided() -> None:
    objective = WassersteinObjective(FIRST, SECOND)
    weights = FIRST.weights, SECOND.weights
    values = {}
    for signs in itertools.product((-1, 1), repeat=3):
        values[signs] = objective(np.array(signs, dtype=np.int8))
        assert values[signs] == pytest.approx(transport_cost(FIRST.points * signs, SECOND.points, weights), rel=1e-12)
    for known in (0, 1, 2):
        for signs in itertools.product((-1, 1), repeat=known):
            bound = objective(np.array([*signs, *[0] * (3 - known)], dtype=np.int8))
            assert 0.0 < bound <= min(value for full, value in values.items() if full[:known] == signs) + 1e-12
