"""The space that proves an upper bound: on random graphs with loops, broken on purpose, and Reeb graphs that are known."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

import surfexp as sx
from surfexp.contract.arrays import Floats, Integers
from surfexp.skeleton.common_space import CommonSpace, common_space_defects, isomorphic
from surfexp.skeleton.complex_reeb_graph import LevelGraph, complex_reeb_graph
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.reeb_distance.bounds import reeb_distance_bounds

Graph = tuple[Floats, Integers]
PAIRS = 240
NO_TRIANGLES = np.zeros((0, 3), dtype=np.int64)
# the third minimum joins the second, or the first
JOINED: tuple[Graph, Graph] = (
    (np.array([0.0, 1, 2, 4, 5, 6]), np.array([(2, 3), (1, 3), (3, 4), (0, 4), (4, 5)])),
    (np.array([0.0, 1, 2, 4, 5, 6]), np.array([(2, 3), (0, 3), (3, 4), (1, 4), (4, 5)])),
)


def random_graph(rng: np.random.Generator) -> Graph:
    """Two to eight nodes with one or two loops, every third time with equal heights."""
    count = int(rng.integers(2, 9))
    heights = rng.integers(0, 5, count) if rng.random() < 1 / 3 else rng.permutation(13)[:count]
    arcs = [(k, int(rng.integers(0, k))) for k in range(1, count)]
    arcs += [tuple(rng.choice(count, 2, replace=False)) for _ in range(rng.integers(1, 3))]
    return heights + rng.choice([0.0, 1.0]) * rng.uniform(0, 1, count), np.array(arcs, dtype=np.int64)


def defects(space: CommonSpace, first: Graph, second: Graph, distance: float) -> str:
    return "; ".join(common_space_defects(space, first, second, distance))


def test_the_space_of_every_random_pair_proves_the_upper_bound() -> None:
    rng = np.random.default_rng(0)
    filled = 0
    for _ in range(PAIRS):
        first, second = random_graph(rng), random_graph(rng)
        found = reeb_distance_bounds(first, second, 1_000)
        assert defects(found.space, first, second, found.upper) == ""
        assert found.space.difference == pytest.approx(found.upper, abs=1e-10)
        assert isinstance(found.space.arcs[0, 0], np.int64)
        filled += len(found.space.triangles) > 0
    # nearly all are graphs
    assert 0 < filled < PAIRS / 20


def test_a_fold_on_a_chain_of_either_graph_is_spread_out_where_the_other_passes() -> None:
    fold = np.array([0.0, 2, 1, 3]), np.array([(0, 1), (1, 2), (2, 3)])
    slope = np.array([0.0, 3]), np.array([(0, 1)])
    for first, second in ((fold, slope), (slope, fold)):
        found = reeb_distance_bounds(first, second)
        assert found.upper == 0.5 and defects(found.space, first, second, 0.5) == ""


def test_a_search_that_was_cut_short_says_what_its_space_proves() -> None:
    chain = np.array([2.0, 10, 0]), np.array([(1, 0), (2, 1)])
    loops = np.array([6.0, 12, 10, 11, 4]), np.array([(1, 0), (2, 0), (3, 0), (4, 2), (2, 4), (4, 3)])
    found = reeb_distance_bounds(chain, loops, 100)
    # both are drawn together to a point, whose product has points of heights 0 and 12
    assert not found.complete and found.upper == found.space.difference == 6
    assert defects(found.space, chain, loops, 6) == ""


def test_a_space_without_one_of_its_arcs_proves_nothing() -> None:
    rng = np.random.default_rng(1)
    for first, second in [JOINED, *((random_graph(rng), random_graph(rng)) for _ in range(10))]:
        found = reeb_distance_bounds(first, second, 1_000)
        for left_out in range(len(found.space.arcs)):
            torn = replace(found.space, arcs=np.delete(found.space.arcs, left_out, axis=0))
            assert defects(torn, first, second, found.upper)


def test_a_space_without_its_triangles_has_a_loop_that_the_graphs_have_not() -> None:
    # four long branches at a short arc: which two are on one side differs, so that they begin at all corners of a square
    heights = np.array([0.0, 1, -10, 20, -23, 37])
    first = heights, np.array([(0, 1), (0, 2), (0, 3), (1, 4), (1, 5)])
    second = heights, np.array([(0, 1), (0, 2), (0, 4), (1, 3), (1, 5)])
    found = reeb_distance_bounds(first, second)
    assert len(found.space.triangles) == 2 and defects(found.space, first, second, found.upper) == ""
    for left_out in range(2):
        hollow = replace(found.space, triangles=np.delete(found.space.triangles, left_out, axis=0))
        assert "Reeb graph by the" in defects(hollow, first, second, found.upper)


def test_a_height_that_is_changed_is_seen() -> None:
    rng = np.random.default_rng(2)
    for _ in range(20):
        first, second = random_graph(rng), random_graph(rng)
        found = reeb_distance_bounds(first, second, 1_000)
        apart = found.space.first - found.space.second
        farther = found.space.first.copy()
        farther[np.abs(apart).argmax()] += 1e-6 * np.sign(apart[np.abs(apart).argmax()])
        assert "functions differ" in defects(replace(found.space, first=farther), first, second, found.upper)
        for name in ("first", "second"):
            lowered = getattr(found.space, name).copy()
            lowered[lowered.argmin()] -= 1e-6
            broken = replace(found.space, **{name: lowered})
            assert f"the {name} graph" in defects(broken, first, second, found.upper + 1)


def test_a_space_is_about_its_graphs_and_its_bound() -> None:
    found = reeb_distance_bounds(*JOINED)
    assert defects(found.space, JOINED[1], JOINED[0], 1).count("Reeb graph by the") == 2
    assert defects(found.space, *JOINED, 0.999) == "its functions differ by 1, more than 0.999"
    beside = replace(found.space, first=np.r_[found.space.first, 4.5], second=np.r_[found.space.second, 4.5])
    assert "it has 2 pieces" in defects(beside, *JOINED, 1)
    twice = replace(found.space, arcs=np.r_[found.space.arcs, found.space.arcs[:1, ::-1]])
    assert "join the same pair" in defects(twice, *JOINED, 1)
    not_a_number = replace(found.space, first=np.where(found.space.first == 6, np.nan, found.space.first))
    assert "differ by nan" in defects(not_a_number, *JOINED, 1)


def test_reeb_graphs_of_complexes_that_are_no_surfaces() -> None:
    # three triangles at one edge: three maxima above its upper end
    book = np.array([(0, 1, 2), (0, 1, 3), (0, 1, 4)])
    sides = np.unique(np.sort([face[list(ends)] for face in book for ends in ((0, 1), (0, 2), (1, 2))], axis=1), axis=0)
    fork = complex_reeb_graph(np.array([0.0, 1, 2, 3, 4]), sides, book)
    assert fork.heights.tolist() == [0, 1, 2, 3, 4] and len(fork.arcs) == 4
    # a filled triangle, and a hollow one
    hollow = np.array([(0, 1), (1, 2), (0, 2)])
    filled = complex_reeb_graph(np.array([0.0, 1, 2]), hollow, np.array([(2, 0, 1)]))
    assert filled.heights.tolist() == [0, 2] and filled.arcs.tolist() == [[0, 1]]
    assert len(complex_reeb_graph(np.array([0.0, 1, 2]), hollow, NO_TRIANGLES).arcs) == 2
    # constant on all of it, and on one side
    for values, heights in (([3.0, 3, 3], [3]), ([0.0, 0, 1], [0, 1])):
        assert complex_reeb_graph(np.array(values), hollow, np.array([(0, 1, 2)])).heights.tolist() == heights
    with pytest.raises(ValueError, match="no arc"):
        complex_reeb_graph(np.array([0.0, 1, 2]), hollow[:2], np.array([(0, 1, 2)]))


@pytest.mark.parametrize("name", ["torus", "icosphere"])
def test_reeb_graphs_of_surfaces_are_those_of_the_sweep(name: str) -> None:
    surface = sx.shape(name, **({"n_u": 16, "n_v": 10} if name == "torus" else {"levels": 2}))
    values = np.random.default_rng(0).standard_normal(len(surface.mesh.vertices))
    pairs = np.concatenate([surface.mesh.faces[:, list(ends)] for ends in combinations(range(3), 2)])
    here = complex_reeb_graph(values, np.unique(np.sort(pairs, axis=1), axis=0), surface.mesh.faces)
    swept = exact_reeb_graph(surface.mesh, values)
    assert len(here.arcs) > 20
    plain = complex_reeb_graph(swept.values, swept.arcs, NO_TRIANGLES)
    assert isomorphic(here, plain)
    assert not isomorphic(here, LevelGraph(plain.heights, np.r_[plain.arcs[1:], plain.arcs[-1:]]))


def test_the_space_of_sampled_graphs_is_checked_in_the_face() -> None:
    torus = sx.shape("torus", n_u=24, n_v=12)
    height = torus.mesh.vertices[:, 0]
    noise = 0.02 * np.random.default_rng(0).standard_normal(len(height))
    first, second = sx.reeb_graph(torus, height), sx.reeb_graph(torus, height + noise)
    found = sx.reeb_distance(first, second)
    assert sx.check_reeb_distance(found, first, second) == ()
    too_good = replace(found, upper=0.9 * found.upper)
    assert "functions differ" in sx.check_reeb_distance(too_good, first, second)[0]
    with pytest.raises(TypeError, match=r"results of sx\.reeb_graph"):
        sx.check_reeb_distance(found, first, torus)  # type: ignore[arg-type]
