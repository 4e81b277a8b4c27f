"""Bounds on the distance of Reeb graphs: against all common spaces of tiny graphs, planted noise, and graphs that look alike."""

from __future__ import annotations

from itertools import combinations, permutations, product

import networkx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfexp as sx
from surfexp.contract.arrays import Floats, Integers
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.reeb_distance.bottleneck import bottleneck_distance
from surfexp.skeleton.reeb_distance.bounds import ReebDistance, lower_bounds, reeb_distance_bounds, upper_bound
from surfexp.skeleton.reeb_distance.extended_persistence import loop_diagram, merge_tree, turned_over
from surfexp.skeleton.reeb_distance.height_graph import height_graph
from surfexp.skeleton.reeb_distance.interleaving import may_be_interleaved

Graph = tuple[Floats, Integers]
EFFORT = 2_000


def graph(heights: list[float], *arcs: tuple[int, int]) -> Graph:
    return np.array(heights, dtype=np.float64), np.array(arcs, dtype=np.int64).reshape(-1, 2)


def path(*heights: float) -> Graph:
    return graph(list(heights), *((k, k + 1) for k in range(len(heights) - 1)))


def circle(*heights: float) -> Graph:
    return graph(list(heights), *((k, (k + 1) % len(heights)) for k in range(len(heights))))


HANDLE = graph([-1, 0, 4, 5], (0, 1), (1, 2), (1, 2), (2, 3))
# the third minimum joins the second, or the first
JOINED = (
    graph([0, 1, 2, 4, 5, 6], (2, 3), (1, 3), (3, 4), (0, 4), (4, 5)),
    graph([0, 1, 2, 4, 5, 6], (2, 3), (0, 3), (3, 4), (1, 4), (4, 5)),
)
# a branch up and a branch down on one side of a loop, or on both
SIDES = (
    graph([-1, 0, 10, 11, 3, 5, 7, 6], (0, 1), (2, 3), (1, 2), (1, 4), (4, 6), (6, 2), (4, 5), (6, 7)),
    graph([-1, 0, 10, 11, 3, 5, 7, 6], (0, 1), (2, 3), (1, 4), (4, 2), (1, 6), (6, 2), (4, 5), (6, 7)),
)


@st.composite
def graphs(draw: st.DrawFn, most: int = 6, loops: int = 1) -> Graph:
    heights = draw(st.lists(st.integers(0, 12), min_size=2, max_size=most, unique=True))
    arcs = [(k, draw(st.integers(0, k - 1))) for k in range(1, len(heights))]
    pairs = st.sampled_from(list(combinations(range(len(heights)), 2)))
    arcs += draw(st.lists(pairs, max_size=loops))
    return graph([float(height) for height in heights], *arcs)


def shuffled(one: Graph, seed: int) -> Graph:
    rng = np.random.default_rng(seed)
    heights, arcs = one
    order, arc_order = rng.permutation(len(heights)), rng.permutation(len(arcs))
    return heights[order], np.argsort(order)[arcs][arc_order][:, ::-1]


def diagrams(one: Graph) -> list[list[tuple[float, ...]]]:
    plain = height_graph(*one)
    trees = [merge_tree(side).diagram for side in (plain, turned_over(plain))]
    return [sorted(map(tuple, points.tolist())) for points in (*trees, loop_diagram(plain))]


def connected_parts(count: int, arcs: Integers) -> list[frozenset[int]]:
    """Connected subgraphs as sets of cells: nodes, then arcs with their ends."""
    parts = [frozenset([node]) for node in range(count)]
    for size in range(1, len(arcs) + 1):
        for some in combinations(range(len(arcs)), size):
            nodes = {int(node) for at in some for node in arcs[at]}
            if networkx.is_connected(networkx.MultiGraph(arcs[list(some)].tolist())):
                parts.append(frozenset(nodes | {count + at for at in some}))
    return parts


def least_common_space(first: Graph, second: Graph, costs: list[float]) -> float:
    """The least cost at which a union of cells of the product of two graphs is a common space, by trying all of them.

    Cells are products of nodes and arcs, and diagonals of the product of two arcs. A union is one of both graphs where the part
    above each cell of either is connected.
    """
    (f, ours), (g, theirs) = first, second
    n, m = len(f), len(g)
    parts = connected_parts(m, theirs)
    allowed_of_first = set(connected_parts(n, ours))

    def fits(height: float, part: frozenset[int], cost: float) -> bool:
        return all(abs(height - g[node]) <= cost for node in part if node < m)

    def exists(cost: float) -> bool:
        over_nodes = [[part for part in parts if fits(height, part, cost)] for height in f]
        if not all(over_nodes):
            return False
        for chosen in product(*over_nodes):
            over_arcs: list[list[frozenset[int] | tuple[int, int, int]]] = []
            for a, b in ours:
                both = chosen[a] & chosen[b]
                diagonals = [
                    (at, int(s), int(t))
                    for at, arc in enumerate(theirs)
                    for s, t in (arc, arc[::-1])
                    if s in chosen[a] and t in chosen[b] and max(abs(f[a] - g[s]), abs(f[b] - g[t])) <= cost
                ]
                over_arcs.append([part for part in parts if part <= both] + diagonals)
            for above in product(*over_arcs):
                if all(_connected_over(cell, chosen, above) for cell in range(m + len(theirs))):
                    return True
        return False

    def _connected_over(
        cell: int, chosen: tuple[frozenset[int], ...], above: tuple[frozenset[int] | tuple[int, int, int], ...]
    ) -> bool:
        there = {node for node, part in enumerate(chosen) if cell in part}
        there |= {n + at for at, part in enumerate(above) if isinstance(part, frozenset) and cell in part}
        crossings = sum(isinstance(part, tuple) and part[0] == cell - m for part in above)
        return frozenset(there) in allowed_of_first if crossings == 0 else crossings == 1 and not there

    return next(cost for cost in sorted(costs) if exists(cost))


@pytest.mark.parametrize(
    ("first", "second", "distance"),
    [
        (path(0, 2, 1, 3), path(0, 1.5, 3), 0.5),
        (graph([0, 1, 3, 2], (0, 1), (1, 2), (1, 3)), path(0, 1.5, 3), 0.5),
        (circle(0, 10), path(0, 5, 10), 5),
        (circle(0, 10), circle(1, 8), 2),
        (path(0, 4), path(1, 7), 3),
        (path(3, 0, 4), path(2, 1, 4), 1),
        (graph([-1, 0, 2, 3], (0, 1), (1, 2), (1, 2), (2, 3)), path(-1, 1, 3), 1),
    ],
    ids=["fold", "branch", "loop", "loops", "intervals", "valleys", "handle"],
)
def test_of_tiny_graphs_no_common_space_is_better(first: Graph, second: Graph, distance: float) -> None:
    found = reeb_distance_bounds(first, second)
    assert found.proved and found.complete and found.upper == pytest.approx(distance, abs=1e-9)
    assert least_common_space(first, second, [0, distance / 2, 0.99 * distance, distance, 2 * distance]) == distance


@settings(max_examples=60, deadline=None)
@given(graphs(4, 0), graphs(3, 1))
def test_all_common_spaces_of_tiny_graphs_are_above_the_lower_bound(first: Graph, second: Graph) -> None:
    everything = [k / 2 for k in range(25)]
    assert lower_bounds((height_graph(*first), height_graph(*second)), 10_000)[1] <= least_common_space(
        first, second, everything
    )


@settings(max_examples=100, deadline=None)
@given(graphs(), graphs())
def test_the_bounds_are_in_order_in_either_order(first: Graph, second: Graph) -> None:
    pair = height_graph(*first), height_graph(*second)
    persistence, lower = lower_bounds(pair, EFFORT)
    upper, complete, _ = upper_bound(pair, EFFORT)
    assert persistence <= lower <= upper + 1e-9
    # no more than where both are drawn together to a point
    assert upper <= max(first[0].max() - second[0].min(), second[0].max() - first[0].min()) + 1e-9
    back = reeb_distance_bounds(second, first, EFFORT)
    assert back.lower == pytest.approx(min(lower, upper))
    if complete and back.complete:
        assert back.upper == pytest.approx(upper)


@settings(max_examples=30, deadline=None)
@given(graphs(7, 2), st.integers(0, 10**6), st.floats(-5, 5), st.sampled_from([0.5, 2.0]))
def test_renumbered_graphs_are_at_distance_0_and_units_scale_it(
    one: Graph, seed: int, shift: float, unit: float
) -> None:
    assert reeb_distance_bounds(one, shuffled(one, seed)).upper == 0
    moved = reeb_distance_bounds(one, (one[0] + shift, one[1]))
    assert moved.lower == pytest.approx(abs(shift)) and moved.upper == pytest.approx(abs(shift)) and moved.proved
    other = (unit * one[0], one[1])
    found = reeb_distance_bounds(one, other, EFFORT)
    down = reeb_distance_bounds((-one[0], one[1]), (-other[0], one[1]), EFFORT)
    twice = reeb_distance_bounds((2 * one[0], one[1]), (2 * other[0], one[1]), EFFORT)
    assert [down.lower, twice.lower / 2] == pytest.approx([found.lower] * 2)
    if found.complete and down.complete and twice.complete:
        assert [down.upper, twice.upper / 2] == pytest.approx([found.upper] * 2)


@settings(max_examples=60, deadline=None)
@given(graphs(5), graphs(5), st.integers(0, 10**6), st.floats(0, 0.45))
def test_heights_that_move_a_little_move_the_bounds_no_more(one: Graph, other: Graph, seed: int, most: float) -> None:
    # heights are whole numbers: no arc turns over
    moved = one[0] + np.random.default_rng(seed).uniform(-most, most, len(one[0])), one[1]
    assert reeb_distance_bounds(one, moved).upper <= most + 1e-9
    before, after = reeb_distance_bounds(one, other), reeb_distance_bounds(moved, other)
    assert abs(before.lower - after.lower) <= most + 1e-9
    if before.complete and after.complete:
        assert abs(before.upper - after.upper) <= most + 1e-9


@settings(max_examples=60, deadline=None)
@given(graphs(5), graphs(5), graphs(5))
def test_what_is_proved_obeys_the_triangle_inequality(one: Graph, two: Graph, three: Graph) -> None:
    ways = reeb_distance_bounds(one, two), reeb_distance_bounds(two, three)
    assert reeb_distance_bounds(one, three).lower <= ways[0].upper + ways[1].upper + 1e-9


def test_the_upper_bound_alone_does_not() -> None:
    # circle, circle with branches, tree: by way of the second 2 + 2.5, at once 5
    one = graph([2, 6, 0], (1, 0), (2, 0), (2, 1))
    two = graph([4, 7, 2, 3, 5, 1], (1, 0), (2, 1), (3, 1), (4, 0), (5, 4), (2, 0))
    three = graph([4, 2, 1, 7, 0, 5], (1, 0), (2, 0), (3, 0), (4, 0), (5, 4))
    bounds = [reeb_distance_bounds(a, b) for a, b in ((one, two), (two, three), (one, three))]
    assert all(found.complete for found in bounds) and [found.upper for found in bounds] == [2, 2.5, 5]
    assert not bounds[2].proved


@pytest.mark.parametrize("persistence", [0.25, 1.0])
@pytest.mark.parametrize("count", [1, 2, 4])
def test_planted_branches_cost_half_their_persistence(persistence: float, count: int) -> None:
    heights, arcs = [-8.0, 0.0, 20.0, 28.0], [(0, 1), (1, 2), (1, 2), (2, 3)]
    for k in range(count):
        # on one side of the loop, up and down in turn
        low, high = arcs.pop(1)
        foot = len(heights)
        heights += [3.0 * (k + 1), 3.0 * (k + 1) + persistence * (-1) ** k]
        arcs[1:1] = [(foot, high), (low, foot), (foot, foot + 1)]
    found = reeb_distance_bounds(graph([-8, 0, 20, 28], (0, 1), (1, 2), (1, 2), (2, 3)), graph(heights, *arcs))
    assert found.proved and found.upper == pytest.approx(persistence / 2)


def test_a_planted_handle_costs_half_its_height_however_long_the_rest() -> None:
    with_loop = graph([0, 10, 10.5, 30], (0, 1), (1, 2), (1, 2), (2, 3))
    assert reeb_distance_bounds(with_loop, path(0, 30)).upper == pytest.approx(0.25)
    found = reeb_distance_bounds(HANDLE, path(-1, 5))
    assert found.proved and found.by_persistence == found.upper == 2


def test_graphs_of_equal_persistence_are_told_apart_by_their_merge_trees() -> None:
    assert diagrams(JOINED[0]) == diagrams(JOINED[1])
    found = reeb_distance_bounds(*JOINED)
    assert found.by_persistence == 0 and found.proved and found.lower == found.upper == 1


def test_graphs_of_equal_persistence_and_merge_trees_are_not_told_apart_from_below() -> None:
    assert diagrams(SIDES[0]) == diagrams(SIDES[1])
    found = reeb_distance_bounds(*SIDES)
    assert found.lower == 0 and found.upper == 0.5 and found.complete and not found.proved
    # yet no isomorphism keeps the heights, so that their distance is not 0
    first, second = (networkx.Graph([(one[0][a], one[0][b]) for a, b in one[1]]) for one in SIDES)
    assert set(map(frozenset, first.edges)) != set(map(frozenset, second.edges))


def subdivided(one: networkx.Graph) -> Graph:
    """Vertices at height 0, a maximum on each edge."""
    edges = list(one.edges)
    heights = [0.0] * len(one) + [1.0] * len(edges)
    return graph(heights, *((end, len(one) + at) for at, edge in enumerate(edges) for end in edge))


def test_distance_0_decides_graph_isomorphism() -> None:
    prism, bipartite = networkx.circular_ladder_graph(3), networkx.complete_bipartite_graph(3, 3)
    copy = networkx.relabel_nodes(prism, dict(enumerate([4, 2, 0, 5, 1, 3])))
    copy = networkx.Graph(networkx.convert_node_labels_to_integers(copy, ordering="sorted"))
    assert reeb_distance_bounds(subdivided(prism), subdivided(copy)).upper == 0
    found = reeb_distance_bounds(subdivided(prism), subdivided(bipartite))
    assert diagrams(subdivided(prism)) == diagrams(subdivided(bipartite)) and found.lower == 0 < found.upper


@settings(max_examples=60, deadline=None)
@given(graphs(7, 3))
def test_diagrams_have_the_known_numbers_of_points(one: Graph) -> None:
    plain = height_graph(*one)
    ordinary, relative, loops = diagrams(one)
    ends = [len({arc[1 - side] for arc in plain.arcs}) for side in (0, 1)]
    assert len(ordinary) == len(plain.heights) - ends[0] - 1 and len(relative) == len(plain.heights) - ends[1] - 1
    assert len(loops) == len(plain.arcs) - len(plain.heights) + 1
    # a loop is as high from below as from above
    turned = sorted((-low, -high) for high, low in loops)
    assert turned == sorted(map(tuple, loop_diagram(turned_over(plain)).tolist()))
    assert all(high > low for high, low in loops)


def test_loops_of_a_ladder_are_its_cells() -> None:
    ladder = graph([0, 1, 2, 5, 3, 4], (0, 1), (1, 2), (2, 3), (0, 5), (5, 3), (1, 4), (4, 3))
    assert diagrams(ladder)[2] == [(5, 0), (5, 1)]
    assert diagrams(HANDLE) == [[], [], [(4, 0)]]


def test_bottleneck_distance_against_all_matchings() -> None:
    rng = np.random.default_rng(3)
    for p, q in product(range(4), range(4)):
        first, second = (np.sort(rng.uniform(0, 1, (k, 2)), axis=1) for k in (p, q))
        ways = []
        for some in permutations([*range(q), *[-1] * p], p):
            costs = [
                np.ptp(first[k]) / 2 if at < 0 else np.abs(first[k] - second[at]).max() for k, at in enumerate(some)
            ]
            ways.append(max([*costs, *(np.ptp(second[at]) / 2 for at in set(range(q)) - set(some)), 0.0]))
        assert bottleneck_distance(first, second) == pytest.approx(min(ways))


def test_interleaving_is_no_less_than_the_bottleneck_distance_and_gives_up_safely() -> None:
    one, other = (merge_tree(height_graph(*some)) for some in JOINED)
    assert not may_be_interleaved(one, other, 0.99, 10_000) and may_be_interleaved(one, other, 1.0, 10_000)
    assert may_be_interleaved(one, other, 0.5, 1)
    # a second minimum of height 4 costs 2, on either side
    valleys, slope = (merge_tree(height_graph(*some)) for some in (path(0, 5, 1, 6), path(0, 6)))
    for ours, theirs in ((valleys, slope), (slope, valleys)):
        assert not may_be_interleaved(ours, theirs, 1.9, 100) and may_be_interleaved(ours, theirs, 2.0, 100)


def test_maps_on_one_surface_have_graphs_no_farther_apart_than_the_maps() -> None:
    torus = sx.shape("torus", n_u=24, n_v=12)
    height = torus.mesh.vertices[:, 0]
    noise = 0.02 * np.random.default_rng(0).standard_normal(len(height))
    one, other = (exact_reeb_graph(torus.mesh, values) for values in (height, height + noise))
    found = reeb_distance_bounds((one.values, one.arcs), (other.values, other.arcs))
    assert 0 < found.lower <= np.abs(noise).max()
    sampled = sx.reeb_distance(sx.reeb_graph(torus, height), sx.reeb_graph(torus, height + noise))
    assert isinstance(sampled, ReebDistance) and 0 < sampled.lower <= sampled.upper


@pytest.mark.parametrize(
    ("given_graph", "message"),
    [
        (graph([]), "0 nodes"),
        (graph([0, np.nan], (0, 1)), "finite"),
        (graph([0, 1, 2], (0, 1)), "2 pieces"),
        (graph([0, 1], (0, 2)), "nodes are 0..1"),
        (
            graph([0, *range(1, 302)], *((0, k) for k in range(1, 302))),
            "301 arcs, the search takes 300: cut short branches",
        ),
    ],
)
def test_graphs_without_a_distance_are_refused(given_graph: Graph, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        reeb_distance_bounds(path(0, 1), given_graph)


def test_the_largest_graphs_that_are_taken_have_bounds() -> None:
    stars = [graph([0, *range(1, 301)], *((0, k) for k in range(1, 301))) for _ in range(2)]
    found = reeb_distance_bounds(stars[0], (stars[1][0] + 0.25, stars[1][1]), effort=400)
    assert 0.25 <= found.lower <= found.upper


def test_what_is_no_reeb_graph_is_refused() -> None:
    torus = sx.shape("torus", n_u=20, n_v=10)
    with pytest.raises(TypeError, match=r"results of sx\.reeb_graph"):
        sx.reeb_distance(torus, torus)  # type: ignore[arg-type]


def test_regular_nodes_and_constant_arcs_do_not_count() -> None:
    plain = height_graph(*path(0, 1, 1, 2, 5))
    assert plain.heights == (0, 5) and plain.arcs == ((0, 1),)
    assert height_graph(*path(3, 3)).heights == (3,)
