"""The direction of functional maps: the published one, which differs from its adjoint, and what follows from it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import lstsq
from scipy.spatial.distance import cdist

from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.functional_map import functional_map, orthogonal_map, vertex_map
from surfexp.embedding.zoomout import refine_with_field, zoomout
from surfexp.spectrum.eigensystem import EigenSystem


def system(count: int, modes: int, seed: int) -> EigenSystem:
    """Functions on points that are nobody's eigenfunctions, so that functional maps of them are far from orthogonal."""
    vectors = np.random.default_rng(seed).normal(size=(count, modes))
    vectors[:, 0] = 1.0
    return EigenSystem(np.arange(modes, dtype=float), vectors / np.sqrt(count), np.zeros(modes), 0.0, True)


def published(source: Floats, target: Floats, areas: Floats, rows: Integers, sizes: range, adjoint: bool) -> Integers:
    """ZoomOut written out: C = target^+ source[rows], then for each target point the nearest C source point."""
    for size in sizes:
        phi, psi, root = source[:, :size], target[:, :size], np.sqrt(areas)[:, None]
        matrix = lstsq(root * psi, root * phi[rows])[0]
        table = cdist(psi @ matrix, phi) if adjoint else cdist(psi, (matrix @ phi.T).T)
        rows = table.argmin(axis=1)
    return rows


@pytest.mark.parametrize("seed", range(4))
def test_zoomout_is_the_published_one_and_not_its_adjoint(seed: int) -> None:
    rng = np.random.default_rng(seed)
    source, target = system(90, 12, seed), system(70, 12, seed + 50)
    areas = rng.uniform(0.5, 2.0, 90), rng.uniform(0.5, 2.0, 70)
    start = rng.integers(0, 90, 70)
    scaled = source.vectors * np.sqrt(areas[0].sum()), target.vectors * np.sqrt(areas[1].sum())
    sizes = range(4, 13, 2)
    rows = zoomout(source, target, areas, start, 4, 12, 2)
    assert (rows == published(*scaled, areas[1], start, sizes, adjoint=False)).all()
    assert (rows != published(*scaled, areas[1], start, sizes, adjoint=True)).mean() > 0.2


def test_zoomout_weighs_samples_by_their_own_areas() -> None:
    rng = np.random.default_rng(11)
    source, target = system(90, 8, 1), system(70, 8, 2)
    areas = rng.uniform(0.5, 2.0, 90), 10.0 ** rng.uniform(-2.0, 2.0, 70)
    start = rng.integers(0, 90, 70)
    phi, psi = source.vectors * np.sqrt(areas[0].sum()), target.vectors * np.sqrt(areas[1].sum())
    some = np.sort(np.random.default_rng(0).choice(70, 30, replace=False))
    rows = published(phi, psi, areas[1], start, range(4, 5), adjoint=False)
    for size in (6, 8):
        root = np.sqrt(areas[1][some])[:, None]
        matrix = lstsq(root * psi[some, :size], root * phi[rows[some], :size])[0]
        rows = cdist(psi[:, :size], (matrix @ phi[:, :size].T).T).argmin(axis=1)
    assert (zoomout(source, target, areas, start, 4, 8, 2, samples=30) == rows).all()


def test_a_map_that_loses_modes_is_undone_in_one_direction_only() -> None:
    rng = np.random.default_rng(3)
    source = rng.normal(size=(200, 6))
    truth = rng.integers(0, 200, 150)
    # not orthogonal: three of the six modes come through weakly
    matrix = np.linalg.qr(rng.normal(size=(6, 6)))[0] * [1.0, 1.0, 1.0, 0.1, 0.1, 0.1]
    target = source[truth] @ matrix.T
    weights = rng.uniform(0.5, 2.0, 150)
    assert functional_map(source, target @ np.linalg.inv(matrix).T, weights, truth) == pytest.approx(np.eye(6))
    assert (vertex_map(matrix, source, target) == truth).all()
    adjoint = cdist(target @ matrix, source).argmin(axis=1)
    assert (adjoint == truth).mean() < 0.5


def test_functional_maps_need_not_be_square() -> None:
    rng = np.random.default_rng(4)
    source, target, truth = rng.normal(size=(40, 3)), rng.normal(size=(30, 5)), rng.integers(0, 40, 30)
    matrix = functional_map(source, target, np.ones(30), truth)
    assert matrix.shape == (5, 3)
    assert (vertex_map(matrix, source, target) == cdist(target, source @ matrix.T).argmin(axis=1)).all()


def test_the_orthogonal_map_takes_source_to_target() -> None:
    rng = np.random.default_rng(5)
    turn = np.linalg.qr(rng.normal(size=(5, 5)))[0]
    source, truth = rng.normal(size=(60, 5)), rng.permutation(60)
    target = source[truth] @ turn.T
    assert orthogonal_map(source, target, rng.uniform(1.0, 2.0, 60), truth) == pytest.approx(turn, abs=1e-12)
    assert (vertex_map(turn, source, target) == truth).all()
    # a pair that does not fit hardly counts where its area is tiny
    target[7] += 50.0
    areas = np.where(np.arange(60) == 7, 1e-9, 1.0)
    assert orthogonal_map(source, target, areas, truth) == pytest.approx(turn, abs=1e-6)
    assert np.abs(orthogonal_map(source, target, 1.0 / areas, truth) - turn).max() > 0.1


def test_refinement_with_a_field_is_one_round_of_the_same_formula() -> None:
    rng = np.random.default_rng(6)
    source, target = system(80, 8, 1), system(60, 8, 2)
    areas = rng.uniform(0.2, 3.0, 80), rng.uniform(0.2, 3.0, 60)
    fields = rng.normal(size=80), rng.normal(size=60)
    start = rng.integers(0, 80, 60)
    found = refine_with_field(source, target, areas, start, fields, 8, 0.3, 1)
    phi, psi = source.vectors * np.sqrt(areas[0].sum()), target.vectors * np.sqrt(areas[1].sum())
    weights = 1.0 / np.sqrt(np.concatenate([[1.0], target.values[1:] * areas[1].sum()]))
    scale = 0.3 * np.sqrt(((psi * weights) ** 2).sum(axis=1).mean())
    roots = np.sqrt(areas[1])[:, None]
    moved = (phi @ lstsq(roots * psi, roots * phi[start])[0].T) * weights
    heights = []
    for field, area in zip(fields, areas, strict=True):
        mean = np.average(field, weights=area)
        heights.append(scale * (field - mean) / np.sqrt(np.average((field - mean) ** 2, weights=area)))
    table = cdist(np.column_stack([psi * weights, heights[1]]), np.column_stack([moved, heights[0]]))
    assert (found == table.argmin(axis=1)).all()


def test_too_few_samples_for_the_largest_map_are_refused() -> None:
    source = system(90, 12, 0)
    areas = np.ones(90), np.ones(90)
    with pytest.raises(ValueError, match="8 samples for a functional map of size 12: take samples >= 12"):
        zoomout(source, source, areas, np.arange(90), 4, 12, 2, samples=8)
