"""Distances between surfaces: what they must leave alone, what they must see, and who obeys the triangle inequality."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from embedded_clouds import cloud
from scipy.spatial.distance import cdist

from surfexp.embedding import spectral_distance as spectral_distance_module
from surfexp.embedding.block_alignment import block_distance
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks, size_at_gap
from surfexp.embedding.mean_hausdorff import summarised
from surfexp.embedding.nearest import mutual_distances, nearest
from surfexp.embedding.spectral_distance import sampled_signs, spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, spectral_embedding
from surfexp.embedding.wasserstein import transport_cost, wasserstein_distance
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.fibonacci_sphere import fibonacci_sphere
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.populations.disguise import disguise
from surfexp.spectrum.eigensolver import eigenpairs


def embed(surface: Surface, n: int) -> SpectralEmbedding:
    elements = surface_elements(surface.mesh)
    return spectral_embedding(eigenpairs(elements.stiffness, elements.mass, n + 1), surface.mesh.vertex_areas, n)


def lopsided(levels: int) -> Surface:
    """An ellipsoid with a bump, which has no symmetry."""
    surface = ellipsoid(levels, (1.0, 1.35, 0.7))
    x, y, z = surface.mesh.vertices.T
    swollen = surface.mesh.vertices * (1.0 + 0.25 * np.sin(2.0 * x + y + 0.5 * z) + 0.1 * y * z)[:, None]
    return Surface(TriangleMesh(swollen, surface.mesh.faces))


@pytest.mark.parametrize("n", [2, 5, 6, 20])
def test_nearest_neighbours_are_exact_in_few_and_many_dimensions(n: int) -> None:
    first, second = cloud(n, 300, 1).points, cloud(n, 290, 2).points
    distances = cdist(first, second)
    rows, found = nearest(first, second)
    assert found == pytest.approx(distances.min(axis=1), rel=1e-9)
    assert (rows == distances.argmin(axis=1)).all()
    forward, backward = mutual_distances(first, second)
    assert forward == pytest.approx(distances.min(axis=1), rel=1e-9)
    assert backward == pytest.approx(distances.min(axis=0), rel=1e-9)


def test_points_upon_points_have_distance_zero_in_many_dimensions() -> None:
    points = cloud(12, 400, 3).points + 100.0
    forward, backward = mutual_distances(points, points[::-1].copy())
    assert forward.max() < 1e-12 and backward.max() < 1e-12


@pytest.mark.parametrize("reading", ["inf_of_max", "max_of_inf"])
def test_the_same_surface_in_disguise_is_at_distance_zero(reading: str) -> None:
    surface = lopsided(3)
    first = embed(surface, 8)
    for seed in (0, 1):
        second = embed(disguise(surface, scale=3.0, seed=seed), 8)
        found = spectral_distance(first, second, reading)
        back = spectral_distance(second, first, reading)
        assert found.value < 1e-6 and found.optimal
        assert back.value < 1e-6
        origin = disguise(surface, scale=3.0, seed=seed).truth.origin
        assert (found.correspondence == origin).mean() > 0.999


def test_the_distance_to_a_remeshed_copy_shrinks_under_refinement() -> None:
    values = []
    for levels in (2, 3, 4):
        surface = lopsided(levels)
        values.append(spectral_distance(embed(surface, 5), embed(disguise(surface, remeshed=True), 5)).value)
    assert values[2] < 0.7 * values[1] < 0.7 * 0.8 * values[0]


def test_symmetry_and_the_order_of_the_readings() -> None:
    first, second = embed(ellipsoid(3, (1, 1.3, 0.8)), 7), embed(ellipsoid(3, (1, 1.9, 0.5)), 7)
    one, other = spectral_distance(first, second), spectral_distance(second, first)
    assert one.value == pytest.approx(other.value, rel=1e-9)
    published = spectral_distance(first, second, "max_of_inf")
    assert published.value <= one.value * (1 + 1e-12)
    assert spectral_distance(first, second, summary="largest").value >= one.value
    assert one.metrics["forward"] <= one.value * (1 + 1e-12) and one.lower_bound == one.value


def test_fast_mode_has_the_signs_of_the_exact_one_or_says_otherwise() -> None:
    shapes = [
        embed(ellipsoid(3, axes), 9) for axes in ((1, 1.3, 0.8), (1, 1.5, 0.7), (1.1, 1.35, 0.6), (0.9, 1.8, 0.7))
    ]
    for i in range(4):
        for j in range(i):
            exact = spectral_distance(shapes[i], shapes[j])
            fast = spectral_distance(shapes[i], shapes[j], samples=300, exact=False)
            assert fast.lower_bound <= exact.value <= fast.value + 1e-12
            assert fast.notes or fast.value == pytest.approx(exact.value, rel=1e-9)


def test_two_directions_may_want_different_signs() -> None:
    differ = 0
    for seed in range(30):
        first, second = cloud(3, 8, seed), cloud(3, 8, seed + 100)
        published, common = (spectral_distance(first, second, reading) for reading in ("max_of_inf", "inf_of_max"))
        assert published.value <= common.value + 1e-12
        assert published.optimal and published.lower_bound == published.value
        differ += published.metrics["same_signs"] == 0.0 and published.value < common.value - 1e-3
    assert differ > 3


def test_blocks_end_at_gaps_common_to_both() -> None:
    first = np.array([1.0, 2.0, 2.01, 3.0, 4.0, 4.01])
    second = np.array([1.0, 2.0, 2.3, 2.31, 4.0, 5.0])
    assert eigenvalue_blocks(first) == ((0, 1), (1, 3), (3, 4), (4, 6))
    assert eigenvalue_blocks(first, second) == ((0, 1), (1, 4), (4, 6))
    assert [size_at_gap(n, first) for n in (1, 2, 3, 4, 5)] == [1, 1, 3, 4, 4]
    with pytest.raises(ValueError, match="take 1 <= n <= 5"):
        size_at_gap(6, first)
    with pytest.raises(ValueError, match="no relative gap"):
        size_at_gap(1, np.array([1.0, 1.001, 1.002]))


def test_remeshed_spheres_agree_up_to_rotations_of_their_eigenspaces() -> None:
    first, second = embed(icosphere(4), 15), embed(fibonacci_sphere(2500), 15)
    blocks = eigenvalue_blocks(first.values, second.values)
    assert blocks == ((0, 3), (3, 8), (8, 15))
    found = block_distance(first, second, blocks, starts=3)
    signs = spectral_distance(first, second, exact=False, samples=200)
    assert found.value < 0.03 < 0.2 < signs.value
    assert found.lower_bound <= found.value and not found.optimal
    assert found.basis.T @ found.basis == pytest.approx(np.eye(15), abs=1e-10)
    assert np.abs(found.basis[:3, 3:]).max() == 0.0


def test_a_known_rotation_inside_a_block_is_found() -> None:
    first = cloud(4, 400, 9)
    turn = np.eye(4)
    turn[1:3, 1:3] = [[0.6, 0.8], [-0.8, 0.6]]
    turn[3, 3] = -1.0
    second = replace(first, points=first.points @ turn.T)
    found = block_distance(first, second, ((0, 1), (1, 3), (3, 4)))
    assert found.value < 1e-9
    assert found.basis == pytest.approx(turn, abs=1e-9)


def test_wasserstein_of_a_shift_and_of_sorted_numbers() -> None:
    rng = np.random.default_rng(0)
    x, equal = rng.normal(size=(60, 1)), np.full(60, 1 / 60)
    y = rng.normal(size=(60, 1)) + 3.0
    sorted_cost = float(np.abs(np.sort(x[:, 0]) - np.sort(y[:, 0])).mean())
    assert transport_cost(x, y, (equal, equal)) == pytest.approx(sorted_cost, rel=1e-9)
    assert transport_cost(x, x + 2.0, (equal, equal), "sinkhorn") == pytest.approx(2.0, rel=0.02)


def test_hausdorff_and_wasserstein_obey_the_triangle_inequality_over_signs() -> None:
    shapes = [cloud(3, 40, seed) for seed in range(5)]
    for distance in (
        lambda a, b: spectral_distance(a, b, summary="largest").value,
        lambda a, b: wasserstein_distance(a, b, samples=40).value,
    ):
        table = np.array([[distance(a, b) for b in shapes] for a in shapes])
        assert table == pytest.approx(table.T, abs=1e-9) and np.abs(np.diag(table)).max() < 1e-9
        assert (table[:, None, :] <= table[:, :, None] + table[None, :, :] + 1e-9).all()


def test_the_lower_bound_of_blocks_is_that_of_their_lengths() -> None:
    """No orthogonal matrix on a block changes the length of a point in it, so lengths alone bound the distance."""
    first, second, blocks = cloud(4, 60, 1), cloud(4, 50, 2), ((0, 1), (1, 3), (3, 4))
    found = block_distance(first, second, blocks, starts=2)
    lengths = [
        np.stack([np.linalg.norm(one.points[:, start:stop], axis=1) for start, stop in blocks], axis=1)
        for one in (first, second)
    ]
    apart = cdist(*lengths)
    bound = max(float(apart.min(axis=1) @ first.weights), float(apart.min(axis=0) @ second.weights))
    assert found.lower_bound == pytest.approx(bound, rel=1e-9)
    assert found.lower_bound < 0.99 * found.value and not found.optimal


@pytest.mark.parametrize("count", [1, 3])
def test_what_single_precision_cannot_tell_apart_is_compared_again(count: int) -> None:
    """Two targets whose distances differ in the ninth digit, in either order."""
    points = np.random.default_rng(0).normal(size=(count, 8)) + 10.0
    step = np.full(8, 1.0 / np.sqrt(8.0))
    for first, second in ((1.0, 1.0 + 1e-9), (1.0 + 1e-9, 1.0)):
        targets = np.concatenate([points + first * step, points + second * step])
        rows, found = nearest(points, targets)
        assert (rows == np.arange(count) + (0 if first < second else count)).all()
        assert found == pytest.approx(1.0, abs=1e-12)


def test_the_correspondence_is_the_nearest_source_point_of_each_target_point() -> None:
    first, second = cloud(5, 60, 3), cloud(5, 50, 4)
    found = spectral_distance(first, second)
    apart = cdist(found.target_points, found.source_points)
    assert (found.correspondence == apart.argmin(axis=1)).all() and len(found.correspondence) == 50
    assert found.metrics["backward"] == pytest.approx(float(apart.min(axis=1) @ second.weights))
    assert found.metrics["forward"] == pytest.approx(float(apart.min(axis=0) @ first.weights))


@pytest.mark.parametrize(("exact", "draws"), [(True, 1), (False, 2)])
def test_signs_that_nothing_proves_are_drawn_twice(exact: bool, draws: int, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[tuple[int, int]] = []

    def watched(*given: Any) -> Any:
        seen.append(given[-2:])
        return sampled_signs(*given)

    monkeypatch.setattr(spectral_distance_module, "sampled_signs", watched)
    spectral_distance(cloud(4, 40, 1), cloud(4, 40, 2), limit=7, exact=exact)
    assert seen == [(draws, 7 if exact else spectral_distance_module.SAMPLED_LIMIT)]


@pytest.mark.parametrize("summary", ["mean", "largest"])
@pytest.mark.parametrize("direction", ["forward", "backward", "both"])
def test_a_summary_is_of_the_distances_each_way(summary: str, direction: str) -> None:
    first, second = cloud(3, 30, 1), cloud(3, 20, 2)
    there, back = np.linspace(0.5, 2.0, 30), np.linspace(0.1, 7.0, 20)
    by_hand = {"mean": (there @ first.weights, back @ second.weights), "largest": (2.0, 7.0)}[summary]
    expected = {"forward": by_hand[0], "backward": by_hand[1], "both": max(by_hand)}[direction]
    found = summarised(there, back, first, second, direction, summary)  # type: ignore[arg-type]
    assert found == pytest.approx(expected, rel=1e-12)
