"""The search over signs equals enumeration, its bounds are bounds, and its log is replayed by other code."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from embedded_clouds import cloud
from scipy.spatial import cKDTree

from surfexp.embedding.mean_hausdorff import HausdorffObjective
from surfexp.embedding.sign_search import (
    Bound,
    SignSearch,
    branch_and_bound,
    enumerate_signs,
    greedy_signs,
    search_signs,
)
from surfexp.embedding.spectral_embedding import SpectralEmbedding
from surfexp.embedding.wasserstein import WassersteinObjective


def check_certificate(search: SignSearch, objective: Bound, tolerance: float = 1e-9) -> list[str]:
    """Replay the log of a search with an objective of one's own; return what is wrong, nothing when the proof holds.

    The closed nodes have to be disjoint and cover all 2^n signs, each bound must be one that `objective` confirms, none
    may lie below the lower bound, and the value must be that of the signs.
    """
    closed, n = search.closed, len(search.signs)
    faults = []
    depths = (closed != 0).sum(axis=1)
    if any((row[:depth] == 0).any() for row, depth in zip(closed, depths, strict=True)):
        faults.append("a closed node has decided signs after undecided ones")
    if sum(2 ** (n - int(depth)) for depth in depths) != 2**n:
        faults.append("the closed nodes do not count to 2^n signs")
    prefixes = {bytes(row[:depth].tobytes()) for row, depth in zip(closed, depths, strict=True)}
    if len(prefixes) < len(closed):
        faults.append("a closed node is listed twice")
    for row, depth in zip(closed, depths, strict=True):
        if any(bytes(row[:k].tobytes()) in prefixes for k in range(int(depth))):
            faults.append("a closed node lies below another")
            break
    slack = tolerance * max(1.0, abs(search.value))
    for row, bound in zip(closed, search.bounds, strict=True):
        if bound > -np.inf and objective(row, np.inf) < min(bound, search.value) - slack:
            faults.append(f"the bound {bound:g} of node {row.tolist()} is not confirmed")
    if search.bounds.min() < search.lower_bound - slack:
        faults.append(f"a node has the bound {search.bounds.min():g} below the lower bound {search.lower_bound:g}")
    if abs(objective(search.signs, np.inf) - search.value) > slack:
        faults.append("the value is not that of the signs")
    return faults


def by_trees(source: SpectralEmbedding, target: SpectralEmbedding):
    """The objective by other means: trees on coordinates and on absolute values."""

    def objective(signs: np.ndarray, cutoff: float = np.inf) -> float:
        known = signs != 0
        x = np.where(known, source.points, np.abs(source.points))
        y = np.where(known, target.points * signs, np.abs(target.points))
        forward, backward = cKDTree(y).query(x)[0], cKDTree(x).query(y)[0]
        return max(float(forward @ source.weights), float(backward @ target.weights))

    return objective


def all_values(objective, n: int) -> dict[tuple[int, ...], float]:
    return {signs: objective(np.array(signs, np.int8), np.inf) for signs in product((1, -1), repeat=n)}


def check_against_enumeration(source: SpectralEmbedding, target: SpectralEmbedding, undecided: str) -> None:
    n = source.dimension
    for direction in ("forward", "both"):
        objective = HausdorffObjective(source, target, direction, undecided=undecided)
        everything = enumerate_signs(objective, n)
        found = branch_and_bound(objective, n)
        assert found.value == pytest.approx(everything.value, rel=1e-12)
        assert found.optimal and found.lower_bound == found.value


@pytest.mark.parametrize("seed", range(50))
def test_branch_and_bound_equals_enumeration(seed: int) -> None:
    n = 2 + seed % 8
    check_against_enumeration(cloud(n, 40, seed), cloud(n, 36, seed + 1000), ("absolute", "prefix")[seed % 2])


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(51))
def test_branch_and_bound_equals_enumeration_of_up_to_4096_signs(seed: int) -> None:
    n = 10 + seed % 3
    check_against_enumeration(cloud(n, 30, seed), cloud(n, 28, seed + 1000), ("absolute", "prefix")[seed // 3 % 2])


@pytest.mark.parametrize("n", [10, 11, 12])
def test_branch_and_bound_equals_enumeration_in_many_dimensions(n: int) -> None:
    source, target = cloud(n, 24, n), cloud(n, 24, n + 50)
    objective = by_trees(source, target)
    assert branch_and_bound(HausdorffObjective(source, target), n).value == pytest.approx(
        min(all_values(objective, n).values()), rel=1e-9
    )


@pytest.mark.slow
@pytest.mark.parametrize("n", [8, 10, 12])
def test_near_symmetric_pairs_of_many_dimensions(n: int) -> None:
    for seed in range(4):
        source = cloud(n, 30, seed, symmetric=1.0)
        rng = np.random.default_rng(seed)
        noise = rng.normal(size=source.points.shape) * np.geomspace(0.6, 0.1, n)
        target = replace(source, points=source.points * rng.choice([-1.0, 1.0], n) + noise)
        check_against_enumeration(source, target, "absolute")


def test_near_symmetric_pairs_defeat_greedy_and_not_the_search() -> None:
    misled = 0
    for seed in range(12):
        source = cloud(7, 40, seed, symmetric=1.0)
        rng = np.random.default_rng(seed)
        signs = rng.choice([-1.0, 1.0], 7)
        noise = rng.normal(size=source.points.shape) * np.geomspace(0.6, 0.1, 7)
        target = replace(source, points=source.points * signs + noise)
        objective = HausdorffObjective(source, target)
        best = min(all_values(by_trees(source, target), 7).values())
        found = branch_and_bound(objective, 7)
        assert found.value == pytest.approx(best, rel=1e-9) and found.optimal
        misled += objective(greedy_signs(objective, 7)[0], np.inf) > best * (1.0 + 1e-6)
    assert misled >= 1


def test_bounds_are_at_most_the_best_completion() -> None:
    source, target = cloud(6, 40, 3), cloud(6, 44, 4)
    for undecided in ("absolute", "prefix"):
        objective = HausdorffObjective(source, target, undecided=undecided)
        values = all_values(objective, 6)
        for prefix in product((1, -1), repeat=3):
            node = np.array([*prefix, 0, 0, 0], np.int8)
            least = min(value for signs, value in values.items() if signs[:3] == prefix)
            assert objective(node, np.inf) <= least * (1 + 1e-12)
            early = objective(node, 0.3 * least)
            assert early <= least * (1 + 1e-12)


@pytest.mark.parametrize("limit", [12, 25, 60])
def test_a_stopped_search_says_so_and_its_bound_holds(limit: int) -> None:
    source, target = cloud(9, 40, 7), cloud(9, 40, 8)
    objective = HausdorffObjective(source, target)
    best = branch_and_bound(objective, 9).value
    stopped = branch_and_bound(objective, 9, np.ones(9, np.int8), limit)
    assert stopped.lower_bound <= best + 1e-12 <= stopped.value + 1e-9
    assert stopped.optimal == (stopped.lower_bound >= stopped.value)
    assert not check_certificate(stopped, by_trees(source, target))


@pytest.mark.parametrize("start", [None, np.ones(7, np.int8)])
def test_every_evaluation_is_counted_once(start: np.ndarray | None) -> None:
    objective, calls = HausdorffObjective(cloud(7, 40, 7), cloud(7, 40, 8)), []

    def counted(signs: np.ndarray, cutoff: float) -> float:
        calls.append(signs.copy())
        return objective(signs, cutoff)

    found = branch_and_bound(counted, 7, start)
    assert found.optimal and found.evaluations == len(calls)


def test_progress_counts_evaluations_and_what_is_left_to_prove() -> None:
    source, target = cloud(9, 40, 7), cloud(9, 40, 8)
    told: list[tuple[int, float]] = []
    found = branch_and_bound(HausdorffObjective(source, target), 9, progress=lambda *step: told.append(step))
    steps, gaps = zip(*told, strict=True)
    assert list(steps) == sorted(steps) and steps[-1] <= found.evaluations
    assert all(0.0 <= gap <= 1.0 for gap in gaps) and gaps[0] == 1.0 and gaps[-1] < 0.5


def test_the_log_is_replayed_by_an_independent_objective_at_twenty_dimensions() -> None:
    source = cloud(20, 300, 1)
    signs = np.where(np.arange(20) % 3 == 0, -1.0, 1.0)
    noise = 0.1 * np.random.default_rng(5).normal(size=source.points.shape)
    target = replace(source, points=source.points * signs + noise)
    found = search_signs(HausdorffObjective(source, target), 20)
    assert (found.signs == signs).all() and found.optimal
    assert found.evaluations < 400
    assert check_certificate(found, by_trees(source, target)) == []


def test_a_forged_log_is_found_out() -> None:
    source, target = cloud(7, 40, 1), cloud(7, 40, 2)
    objective = by_trees(source, target)
    found = branch_and_bound(HausdorffObjective(source, target), 7)
    assert check_certificate(found, objective) == []
    assert check_certificate(replace(found, closed=found.closed[1:], bounds=found.bounds[1:]), objective)
    assert check_certificate(replace(found, value=0.9 * found.value), objective)
    assert check_certificate(replace(found, lower_bound=1.1 * found.value), objective)
    shallow = found.closed.copy()
    shallow[0, -1] = -shallow[0, -1]
    assert check_certificate(replace(found, closed=shallow), objective)
    assert check_certificate(replace(found, bounds=np.where(found.bounds > 0, 9.0, 9.0), value=9.0), objective)


def test_the_same_search_serves_hausdorff_and_wasserstein() -> None:
    source, target = cloud(6, 30, 5), cloud(6, 30, 6)
    for objective in (HausdorffObjective(source, target, summary="largest"), WassersteinObjective(source, target)):
        assert branch_and_bound(objective, 6).value == pytest.approx(min(all_values(objective, 6).values()), rel=1e-9)


def test_senseless_requests_are_refused() -> None:
    objective = HausdorffObjective(cloud(3, 10, 0), cloud(3, 10, 1))
    with pytest.raises(ValueError, match="n = 0 signs"):
        search_signs(objective, 0)
    with pytest.raises(ValueError, match="limit = 1"):
        search_signs(objective, 3, None, 1)
    with pytest.raises(ValueError, match="embeddings differ"):
        HausdorffObjective(cloud(3, 10, 0), cloud(4, 10, 1))


def test_what_was_tried_out_is_proved() -> None:
    first, second = cloud(4, 30, 1), cloud(4, 30, 2)
    objective = HausdorffObjective(first, second)
    found = enumerate_signs(objective, 4)
    values = {signs: objective(np.array(signs, dtype=np.int8)) for signs in product((-1, 1), repeat=4)}
    assert found.optimal and found.lower_bound == found.value == min(values.values()) == values[tuple(found.signs)]
    assert found.evaluations == 16 and len(found.closed) == 16
