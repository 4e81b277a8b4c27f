"""Bounds on the universal distance of two Reeb graphs."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.summary import Summarized, Summary
from surfexp.skeleton.common_space import CommonSpace
from surfexp.skeleton.reeb_distance.bottleneck import bottleneck_distance, least
from surfexp.skeleton.reeb_distance.contraction import Contraction
from surfexp.skeleton.reeb_distance.contraction_order import Contractions
from surfexp.skeleton.reeb_distance.extended_persistence import loop_diagram, merge_tree, turned_over
from surfexp.skeleton.reeb_distance.height_graph import HeightGraph, height_graph, with_tails
from surfexp.skeleton.reeb_distance.interleaving import may_be_interleaved
from surfexp.skeleton.reeb_distance.matching import Budget, matched
from surfexp.skeleton.reeb_distance.product_space import Match, common_space

# of the largest height: what rounding may add to a bound
ROUNDING = 1e-12
Pair = tuple[HeightGraph, HeightGraph]


@dataclass(frozen=True, repr=False)
class ReebDistance(Summarized):
    """Bounds on the distance of two Reeb graphs, in the unit of their heights.

    Parameters
    ----------
    lower, upper : float
        The universal distance lies between them, up to 1e-12 of the largest height.
    by_persistence : float
        What the diagrams of extended persistence alone prove; `lower` is at least this.
    proved : bool
        Whether the bounds meet, so that both are the distance.
    complete : bool
        Whether the upper bound is the least that contractions give; else a search gave up and a larger `effort` may lower it.
    space : CommonSpace
        Its two functions differ by the upper bound, and their Reeb graphs are those given; `check_reeb_distance` checks it.
    """

    lower: float
    upper: float
    by_persistence: float
    proved: bool
    complete: bool
    space: CommonSpace

    @property
    def notes(self) -> tuple[str, ...]:
        """What may be better than it says."""
        return () if self.complete else ("the search was cut short: a larger effort may lower the upper bound",)

    def _summary(self) -> Summary:
        facts = {"at least": self.lower, "at most": self.upper, "proved": self.proved}
        return Summary("distance of Reeb graphs", facts, self.notes)


def reeb_distance_bounds(
    first: tuple[Floats, Integers], second: tuple[Floats, Integers], effort: int = 10_000
) -> ReebDistance:
    """Bound the universal distance of two Reeb graphs.

    It is the least e such that both are Reeb graphs of functions on one connected space that differ by e at most (Bauer, Landi,
    Memoli 2020). From below: heights at the ends, diagrams of loops, and interleavings of the merge trees of both sides. From
    above: a space that is made of both graphs after chains have been drawn together.

    Parameters
    ----------
    first, second : ((n,) float64, (m, 2) int64)
        Heights of the nodes, and arcs.
    effort : int
        Steps of each search, and a twentieth of it contractions of each graph.

    Returns
    -------
    ReebDistance

    Raises
    ------
    ValueError
        If a graph has no node, a height that is not finite, or several pieces.
    """
    graphs = height_graph(*first), height_graph(*second)
    _, slack = candidates(graphs)
    by_persistence, lower = lower_bounds(graphs, effort)
    upper, complete, match = upper_bound(graphs, effort, lower)
    space = common_space(match)
    # where the search was cut short, its space may prove more than it looked for
    if space.difference < upper - slack:
        upper = space.difference
    return ReebDistance(min(lower, upper), upper, by_persistence, bool(upper - lower <= slack), complete, space)


def candidates(graphs: Pair) -> tuple[Floats, float]:
    """Return the numbers of which one is the bound, and what rounding may add.

    Parameters
    ----------
    graphs : pair of HeightGraph

    Returns
    -------
    (k,) float64
        Increasing: differences of heights between the graphs, and halves of those within each.
    float
    """
    f, g = (np.array(graph.heights) for graph in graphs)
    halves = [np.abs(one[:, None] - one[None]).ravel() / 2 for one in (f, g)]
    costs = np.unique(np.concatenate([np.abs(f[:, None] - g[None]).ravel(), *halves]))
    return costs, ROUNDING * max(float(np.abs(f).max()), float(np.abs(g).max()))


def lower_bounds(graphs: Pair, effort: int) -> tuple[float, float]:
    """Return what diagrams prove, and what diagrams and merge trees prove together.

    Parameters
    ----------
    graphs : pair of HeightGraph
    effort : int

    Returns
    -------
    float
    float
        No less.
    """
    costs, slack = candidates(graphs)
    diagrams = bottleneck_distance(*(loop_diagram(graph) for graph in graphs))
    interleaved = 0.0
    for sides in (graphs, (turned_over(graphs[0]), turned_over(graphs[1]))):
        one, other = (merge_tree(graph) for graph in sides)
        ends = abs(float(one.merges.min() - other.merges.min()))
        diagrams = max(diagrams, ends, bottleneck_distance(one.diagram, other.diagram))
        least_shift = least(costs, lambda cost: may_be_interleaved(one, other, cost + slack, effort))  # noqa: B023
        interleaved = max(interleaved, least_shift)
    return diagrams, max(diagrams, interleaved)


def upper_bound(graphs: Pair, effort: int, lower: float = 0.0) -> tuple[float, bool, Match]:
    """Return the least distance at which two contractions are found to be the same graph.

    Parameters
    ----------
    graphs : pair of HeightGraph
    effort : int
    lower : float
        Less is not looked for.

    Returns
    -------
    float
    bool
        Whether no contractions give less.
    Match
        The contractions that were found.
    """
    costs, slack = candidates(graphs)
    costs = costs[costs >= lower - slack]
    first, second = (Contractions(with_tails(graph), max(effort // 20, 1)) for graph in graphs)
    whole: dict[float, bool] = {}
    # at the largest both may be drawn together to a point
    found = {float(costs[-1]): Match(first.to_a_point(), second.to_a_point(), [], float(costs[-1]))}

    def possible(cost: float) -> bool:
        distance, left = cost + slack, effort
        (ours, all_ours), (theirs, all_theirs) = (one.up_to(2 * distance) for one in (first, second))
        whole[cost] = all_ours and all_theirs
        alike: dict[object, list[Contraction]] = defaultdict(list)
        for other in theirs:
            alike[other.signature].append(other)
        for one, other in ((a, b) for a in ours for b in alike[a.signature]):
            # no pair may use up what is there for all
            budget = Budget(min(left, max(effort // 20, 1)))
            left -= budget.left
            if (chains := matched(one, other, distance, budget)) is not None:
                found[cost] = Match(one, other, chains, distance)
                return True
            left += max(budget.left, 0)
            whole[cost] &= budget.left >= 0
        return False

    reach = 1
    while reach < len(costs) and not possible(float(costs[reach - 1])):
        reach *= 2
    upper = least(costs[reach // 2 : reach], possible)
    below = costs[costs < upper]
    return upper, not len(below) or whole.get(float(below[-1]), False), found[upper]
