"""Mean distances between classes worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.statistics.class_distances import class_distances, pair_distances
from surfexp.statistics.distance_matrix import DistanceMatrix

PLACES = np.array([0.0, 2.0, 5.0, 11.0])
MATRIX = DistanceMatrix(tuple("pqrs"), np.abs(np.subtract.outer(PLACES, PLACES)), tuple("aabc"), tuple("pqrs"))


def test_pairs_of_points_on_a_line() -> None:
    """a is 0 and 2, b is 5, c is 11: means 4, 10 and 6, over their own mean 20/3."""
    names, distances = pair_distances(MATRIX)
    assert names == ["a", "b", "c"]
    assert [distances[0, 1], distances[0, 2], distances[1, 2]] == pytest.approx([4.0, 10.0, 6.0])
    found = class_distances(MATRIX)
    assert found.rows == ("a, b", "b, c", "a, c")
    assert found.columns["distance"] == pytest.approx([0.6, 0.9, 1.5])
    assert found.metrics == pytest.approx({"members": 4.0, "nearest": 0.6, "farthest": 1.5})


@pytest.mark.parametrize(("pair", "distance", "rank"), [("ba", 0.6, 1.0), ("bc", 0.9, 2.0), ("ca", 1.5, 3.0)])
def test_a_named_pair_has_its_distance_and_rank_in_any_order(pair: str, distance: float, rank: float) -> None:
    metrics = class_distances(MATRIX, *pair).metrics
    assert metrics["relatives"] == pytest.approx(distance) and metrics["relatives_rank"] == rank


def test_a_pair_that_the_collection_lacks_has_no_rank_and_a_note() -> None:
    found = class_distances(MATRIX, "a", "x")
    assert found.metrics == class_distances(MATRIX).metrics
    assert "'a' and 'x' are not both among a, b, c" in found.notes[-1]
