"""Rearrangements: all of them, each once, inside their blocks, by enumeration with itertools."""

from __future__ import annotations

from itertools import permutations as every_order

import numpy as np
import pytest

from surfexp.inference.rearrangements import permutations, sign_flips, unchanged

RANDOM = np.random.default_rng(0)
SINGLE = np.arange(6)


def test_all_flips_of_units() -> None:
    units = np.array([0, 0, 1, 2, 2])
    found = sign_flips(units, 8, RANDOM)
    assert found.complete and len({tuple(row) for row in found.signs}) == len(found) == 8
    assert (found.signs[:, 0] == found.signs[:, 1]).all() and (found.signs[:, 3] == found.signs[:, 4]).all()
    drawn = sign_flips(units, 7, RANDOM)
    assert not drawn.complete and len(drawn) == 7 and (drawn.signs[0] == 1.0).all()


@pytest.mark.parametrize(
    ("strata", "rows"),
    [
        ([0] * 6, [0, 0, 0, 1, 1, 1]),
        ([0] * 6, [0, 1, 2, 2, 1, 0]),
        ([0, 0, 1, 1, 2, 2], [0, 1, 0, 1, 0, 1]),
        ([0, 0, 0, 1, 1, 1], [3, 1, 2, 1, 1, 2]),
    ],
)
def test_all_permutations_that_differ(strata: list[int], rows: list[int]) -> None:
    design = np.array(rows, dtype=float)[:, None]
    found = permutations(SINGLE, np.array(strata), design, 1000, RANDOM)
    wanted = {
        tuple(np.array(rows)[np.argsort(order)])
        for order in every_order(range(6))
        if all(strata[a] == strata[b] for a, b in enumerate(order))
    }
    given_design = [tuple(np.array(rows)[np.argsort(sources)]) for sources in found.sources]
    assert found.complete and len(given_design) == len(wanted) and set(given_design) == wanted
    assert all(sorted(sources) == list(range(6)) for sources in found.sources)
    fewer = permutations(SINGLE, np.array(strata), design, len(wanted) - 1, RANDOM)
    assert not fewer.complete and (fewer.sources[0] == SINGLE).all()
    assert (np.array(strata)[fewer.sources] == strata).all()


def test_whole_blocks_move_with_their_order() -> None:
    units = np.array([0, 1, 0, 1, 2, 2])
    found = permutations(units, np.zeros(3, dtype=int), np.arange(6.0)[:, None], 6, RANDOM)
    assert found.complete and len(found) == 6
    pairs = {(0, 2), (1, 3), (4, 5)}
    for sources in found.sources:
        assert {(sources[0], sources[2]), (sources[1], sources[3]), (sources[4], sources[5])} == pairs


def test_weights_are_carried_to_the_data() -> None:
    data, weights = RANDOM.standard_normal(6), RANDOM.standard_normal(6)
    found = permutations(SINGLE, np.zeros(6, dtype=int), np.arange(6.0)[:, None], 20, RANDOM)
    moved = data[found.sources] * found.signs
    np.testing.assert_allclose(found.carried(weights) @ data, moved @ weights, atol=1e-14)
    assert (unchanged(6).carried(weights)[0] == weights).all()


def test_random_permutations_are_uniform() -> None:
    found = permutations(SINGLE[:3], np.zeros(3, dtype=int), np.arange(3.0)[:, None], 5, np.random.default_rng(1))
    assert len(found) == 5
    many = permutations(np.arange(8), np.zeros(8, dtype=int), np.arange(8.0)[:, None], 8001, np.random.default_rng(1))
    counts = np.array([np.bincount(column, minlength=8) for column in many.sources[1:].T])
    # 64 counts of 1,000 with a standard deviation of 30
    assert np.abs(counts - 1000).max() < 4.5 * 30
