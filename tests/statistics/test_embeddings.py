"""Embeddings: exact recovery of points, negative eigenvalues, stress, and the same result each time."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.multidimensional_scaling import (
    classical_scaling,
    manifold_embedding,
    neighbour_embedding,
    principal_components,
    stress,
    stress_majorisation,
)
from surfexp.statistics.signature_distances import euclidean


def of_points(points: np.ndarray, coordinates: bool = True) -> DistanceMatrix:
    classes = tuple("ab"[i % 2] for i in range(len(points)))
    labels = tuple(f"{name} {i}" for i, name in enumerate(classes))
    return DistanceMatrix(
        labels, euclidean(points), classes, coordinates=points if coordinates else None, name="points"
    )


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6), st.integers(3, 12))
def test_points_of_the_plane_are_recovered(seed: int, count: int) -> None:
    matrix = of_points(np.random.default_rng(seed).normal(size=(count, 2)))
    found = classical_scaling(matrix)
    assert np.allclose(euclidean(found.points), matrix.values, atol=1e-7)
    assert found.metrics["stress"] < 1e-6
    assert found.metrics["explained"] == pytest.approx(1.0)
    assert found.metrics["negative_share"] == 0.0


def test_classical_scaling_of_euclidean_distances_is_principal_components() -> None:
    matrix = of_points(np.random.default_rng(1).normal(size=(15, 6)) * np.arange(6, 0, -1))
    classical, components = classical_scaling(matrix, 3), principal_components(matrix, 3)
    assert np.allclose(classical.points, components.points, atol=1e-9)
    assert classical.metrics["explained"] == pytest.approx(components.metrics["explained"])


def test_distances_of_no_euclidean_space_have_negative_eigenvalues() -> None:
    # a star: three leaves at distance 2 from one another, all at distance 1 from the middle
    values = np.array([[0.0, 1, 1, 1], [1, 0, 2, 2], [1, 2, 0, 2], [1, 2, 2, 0]])
    found = classical_scaling(DistanceMatrix(("m", "a", "b", "c"), values))
    assert found.metrics["negative_share"] == pytest.approx(0.25 / 4.25, rel=1e-9)


def test_majorisation_has_no_more_stress_than_the_classical_embedding() -> None:
    rng = np.random.default_rng(3)
    matrix = of_points(rng.normal(size=(20, 5)))
    classical, least = classical_scaling(matrix), stress_majorisation(matrix, seed=5)
    assert least.metrics["stress"] < classical.metrics["stress"]
    assert least.metrics["stress"] == pytest.approx(stress(matrix.values, least.points))
    assert np.array_equal(least.points, stress_majorisation(matrix, seed=5).points)
    assert np.allclose(least.points.mean(axis=0), 0.0, atol=1e-12)


def test_majorisation_ends_where_guttmans_transform_stands_still() -> None:
    matrix = of_points(np.random.default_rng(4).normal(size=(15, 5)))
    points = stress_majorisation(matrix, 3).points
    ratio = matrix.values / (euclidean(points) + np.eye(15))
    transformed = (np.diag(ratio.sum(axis=1)) - ratio) @ points / 15
    assert np.abs(transformed - points).max() < 1e-4 * np.abs(points).max()


def test_majorisation_finds_points_whose_distances_are_given() -> None:
    matrix = of_points(np.random.default_rng(2).normal(size=(9, 2)), coordinates=False)
    found = stress_majorisation(matrix)
    assert np.allclose(euclidean(found.points), matrix.values, atol=1e-6)


def test_majorisation_of_equal_members_is_one_point() -> None:
    found = stress_majorisation(DistanceMatrix(("a", "b", "c", "d"), np.zeros((4, 4))))
    assert found.metrics["stress"] == 0.0 and not found.points.any()


def test_neighbours_stay_together() -> None:
    rng = np.random.default_rng(0)
    points = np.concatenate([rng.normal(size=(12, 4)), 30.0 + rng.normal(size=(12, 4))])
    found = neighbour_embedding(of_points(points), seed=1).points
    assert np.isfinite(found).all()
    distances = euclidean(found) + np.diag(np.full(24, np.inf))
    assert (distances.argmin(axis=1) // 12 == np.arange(24) // 12).all()


def test_unfit_requests_are_refused() -> None:
    matrix = of_points(np.eye(3), coordinates=False)
    with pytest.raises(ValueError, match="without coordinates"):
        principal_components(matrix)
    with pytest.raises(ValueError, match="take 1 to 2"):
        classical_scaling(matrix, 3)
    for spoil, words in (
        (lambda v: v - 1.0, "not negative"),
        (lambda v: v + np.triu(v), "symmetric"),
        (lambda v: np.where(v > 1, np.nan, v), "not finite"),
        (lambda v: v[:2], "numbers must agree"),
    ):
        with pytest.raises(ValueError, match=words):
            DistanceMatrix(matrix.labels, spoil(matrix.values))


def test_umap_says_when_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "umap", None)
    with pytest.raises(ImportError, match=r"needs umap-learn, .*pip install 'surfexp\[peers\]'"):
        manifold_embedding(of_points(np.random.default_rng(0).normal(size=(12, 3))))


@pytest.mark.slow
def test_umap_keeps_far_clusters_apart() -> None:
    pytest.importorskip("umap")
    rng = np.random.default_rng(0)
    matrix = of_points(np.concatenate([rng.normal(size=(12, 3)), 100.0 + rng.normal(size=(12, 3))]))
    found = manifold_embedding(matrix, seed=3)
    assert found.points.shape == (24, 2) and np.array_equal(found.points, manifold_embedding(matrix, seed=3).points)
    distances = euclidean(found.points)
    assert distances[:12, :12].max() < distances[:12, 12:].min()
