"""Pairs of modes where they are known: permuted and flipped modes, mixtures, and turned copies."""

import numpy as np
import pytest

from surfexp.embedding.mode_pairs import (
    ModePairs,
    counterparts,
    mode_correlations,
    pairs_by_correlation,
    pairs_in_order,
)
from surfexp.embedding.rigid_alignment import rigid_map
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.populations.disguise import random_rotation

RNG = np.random.default_rng(4)
WEIGHTS = RNG.uniform(0.5, 2.0, 400)
WEIGHTS /= WEIGHTS.sum()
SHUFFLE = RNG.permutation(400)


def orthonormal(columns: np.ndarray) -> np.ndarray:
    """Orthonormal and without mean, by area."""
    root = np.sqrt(WEIGHTS)[:, None]
    return np.linalg.qr(root * np.column_stack([np.ones(400), columns]))[0][:, 1:] / root


MODES = orthonormal(RNG.normal(size=(400, 6)) ** 3)


def test_permuted_and_flipped_modes_are_found_through_a_shuffled_map() -> None:
    order, signs = np.array([2, 0, 1, 5, 3, 4]), np.array([1, -1, 1, 1, -1, -1])
    # target mode j is source mode order[j] with a sign, at the shuffled vertices
    target = (MODES * 3.0)[SHUFFLE][:, order] * signs
    table = mode_correlations(MODES, target, WEIGHTS[SHUFFLE] * 7.0, SHUFFLE)
    np.testing.assert_allclose(np.abs(table), np.eye(6)[order], atol=1e-12)
    for found in (counterparts(table), pairs_by_correlation(table)):
        assert found.partners.tolist() == np.argsort(order).tolist()
        assert found.signs.tolist() == signs[np.argsort(order)].tolist() and found.paired.all()


def test_mixed_modes_have_no_counterpart_but_a_partner() -> None:
    turn = np.eye(6)
    for angle, start in ((0.7, 0), (np.pi / 4, 2), (1.2, 4)):
        part = slice(start, start + 2)
        turn[part, part] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    table = mode_correlations(MODES, MODES @ turn.T, WEIGHTS, np.arange(400))
    np.testing.assert_allclose(table, turn, atol=1e-12)
    assert counterparts(table, 0.51).partners.tolist() == [0, 1, -1, -1, 5, 4]
    assert counterparts(table, 0.51).signs.tolist() == [1, 1, 0, 0, 1, -1]
    assert counterparts(table, 0.6).partners.tolist() == [-1, -1, -1, -1, 5, 4]
    assert pairs_by_correlation(table).paired.all()


def test_counterparts_are_mutual() -> None:
    table = np.array([[0.9, 0.8], [0.1, 0.2]])
    assert counterparts(table).partners.tolist() == [0, -1]
    assert pairs_by_correlation(table).partners.tolist() == [0, 1]
    # the largest sum of absolute values, not the largest entry first
    assert pairs_by_correlation(np.array([[-0.9, 0.8], [0.8, 0.1]])).partners.tolist() == [1, 0]
    assert pairs_by_correlation(np.array([[0.1, 0.9, 0.2]])).partners.tolist() == [-1, 0, -1]


def test_signs_in_order_by_moment_and_by_largest_entry() -> None:
    areas = np.array([1.0, 1.0, 10.0])
    modes = np.array([[5.0, -5.0], [-1.0, 1.0], [-4.0, 3.0]])
    # moments 125 - 1 - 640 < 0 and -125 + 1 + 270 > 0; largest entries 5 and -5
    flipped = -modes[::-1]
    for rule, signs in (("skewness", [-1, -1]), ("largest", [-1, -1])):
        assert pairs_in_order(modes, flipped, areas, areas[::-1], rule).signs.tolist() == signs
    ones = np.ones((3, 2))
    assert pairs_in_order(modes, ones, areas, areas, "skewness").signs.tolist() == [-1, 1]
    found = pairs_in_order(modes, ones, areas, areas, "largest")
    assert found.signs.tolist() == [1, -1] and found.partners.tolist() == [0, 1]


def test_the_sign_of_a_mode_without_mean_is_that_of_its_skewness() -> None:
    modes, areas = np.array([[-2.0], [1.0], [1.0]]), np.ones(3)
    assert pairs_in_order(modes, np.ones((3, 1)), areas, areas).signs.tolist() == [-1]
    assert pairs_in_order(-modes, np.ones((3, 1)), areas, areas).signs.tolist() == [1]
    areas = np.array([1.0, 5.0, 5.0])  # -8 + 5 + 5 > 0
    assert pairs_in_order(modes, np.ones((3, 1)), areas, areas).signs.tolist() == [1]


def test_means_of_modes_do_not_count_in_correlations() -> None:
    rows = np.arange(400)
    table = mode_correlations(MODES + 3.0, 2.0 * MODES - 5.0, WEIGHTS, rows)
    np.testing.assert_allclose(table, np.eye(6), atol=1e-12)


def test_agreement_needs_partner_and_sign() -> None:
    one = ModePairs(np.array([0, 1, -1, 3]), np.array([1, -1, 0, 1], np.int8))
    other = ModePairs(np.array([0, 1, -1, 2]), np.array([1, 1, 0, 1], np.int8))
    assert one.agrees(other).tolist() == [True, False, True, False]
    assert one.agrees(other, signs=False).tolist() == [True, True, True, False]
    assert one.paired.tolist() == [True, True, False, True]


def test_turned_scaled_and_shuffled_points_are_mapped_onto_themselves() -> None:
    # a shape without symmetry, for which only one of the four turns is right
    body = ellipsoid(3, (1.0, 1.5, 2.5)).mesh
    points = body.vertices + 0.3 * np.sin(2.0 * body.vertices[:, [1, 2, 0]] + 0.5)
    order = np.random.default_rng(1).permutation(len(points))
    for seed in range(4):
        target = 3.0 * points[order] @ random_rotation(seed).T + [5.0, -2.0, 9.0]
        rows, misfit = rigid_map(points, target, body.vertex_areas, body.vertex_areas[order])
        assert (rows == order).all() and misfit < 1e-9
    mirrored = points[order] * [-1.0, 1.0, 1.0]
    assert rigid_map(points, mirrored, body.vertex_areas, body.vertex_areas[order])[1] > 0.01


def test_a_flat_shape_is_not_mapped_onto_its_mirror_image() -> None:
    """Which is near it, so that the best orthogonal map of closest points is a reflection."""
    x, y = np.random.default_rng(2).uniform(-1.0, 1.0, (2, 600)) * [[2.0], [1.0]]
    points = np.column_stack([x, y + 0.2 * x**2, 0.05 * np.sin(3.0 * x + 1.0) * (1.0 + y)])
    rows, misfit = rigid_map(points, points * [1.0, 1.0, -1.0], np.ones(600), np.ones(600))
    assert misfit > 0.02
    rows, misfit = rigid_map(points, points, np.ones(600), np.ones(600))
    assert (rows == np.arange(600)).all() and misfit < 1e-9


def test_closest_points_mend_a_start_that_is_not_exact() -> None:
    body = ellipsoid(3, (1.0, 1.5, 2.5)).mesh
    points = body.vertices + 0.3 * np.sin(2.0 * body.vertices[:, [1, 2, 0]] + 0.5)
    # another measure turns the principal axes
    uneven = body.vertex_areas * (1.0 + 0.5 * np.sign(points[:, 0] + points[:, 1]))
    few, many = (rigid_map(points, points, body.vertex_areas, uneven, n)[1] for n in (1, 60))
    assert many < few


def test_what_has_no_meaning_is_refused() -> None:
    ones = np.ones(400)
    with pytest.raises(ValueError, match="rule 'mean' is unknown"):
        pairs_in_order(MODES, MODES, WEIGHTS, WEIGHTS, "mean")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="6 modes against 5"):
        pairs_in_order(MODES, MODES[:, :5], WEIGHTS, WEIGHTS)
    for share in (-0.1, 1.0):
        with pytest.raises(ValueError, match="take one from 0 to below 1"):
            counterparts(np.eye(2), share)
    with pytest.raises(ValueError, match="iterations = 0"):
        rigid_map(MODES[:, :3], MODES[:, :3], ones, ones, 0)
    with pytest.raises(ValueError, match="400 points coincide"):
        rigid_map(np.zeros((400, 3)), MODES[:, :3], ones, ones)
