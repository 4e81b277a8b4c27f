"""The distance of two Reeb graphs, and the check of what proves it from above."""

from __future__ import annotations

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.given_numbers import whole_number
from surfexp.skeleton.common_space import common_space_defects
from surfexp.skeleton.reeb_distance.bounds import ReebDistance, reeb_distance_bounds
from surfexp.skeleton.skeleton import Skeleton

MOST_EFFORT = 10_000_000


def reeb_distance(first: Skeleton, second: Skeleton, *, effort: int = 10_000) -> ReebDistance:
    """Return bounds on the distance of two Reeb graphs: what is proved from below, and what a common space shows.

    The distance is the least e such that both are Reeb graphs of functions on one connected space that differ by e at most. Two
    maps on one surface have graphs no farther apart than the maps. Deciding whether it is 0 is as hard as graph isomorphism, so
    that the bounds need not meet.

    Parameters
    ----------
    first, second : Skeleton
        Results of `reeb_graph`, of one piece each; their `values` and `arcs` count, not their positions.
    effort : int
        Steps of each search.

    Returns
    -------
    ReebDistance
        `lower`, `upper`, and `proved` where they meet, in the unit of the maps; about the sampled graphs. `space` proves the upper
        bound, `check_reeb_distance` checks it.

    Raises
    ------
    ValueError
        If a graph has several pieces, or more than 300 arcs.
    TypeError
        If it is no result of `reeb_graph`.

    References
    ----------
    Bauer, Landi, Memoli: The Reeb graph edit distance is universal (2020), doi 10.4230/LIPIcs.SoCG.2020.15.

    Examples
    --------
    >>> import surfexp as sx
    >>> torus = sx.shape("torus")
    >>> height = torus.mesh.vertices[:, 0]
    >>> sx.reeb_distance(sx.reeb_graph(torus, height), sx.reeb_graph(torus, height + 0.25))
    <ReebDistance: distance of Reeb graphs, at least 0.25, at most 0.25, proved yes>
    """
    effort = whole_number(effort, "effort", 1, MOST_EFFORT)
    return reeb_distance_bounds(_graph(first), _graph(second), effort)


def check_reeb_distance(found: ReebDistance, first: Skeleton, second: Skeleton) -> tuple[str, ...]:
    """Return what keeps the space of a result from proving its upper bound; nothing where it is proved.

    The search is not repeated and nothing of it is used. The Reeb graphs of both functions on the space are computed, at all its
    levels, and compared with the graphs that are given, heights included.

    Parameters
    ----------
    found : ReebDistance
        As `reeb_distance` returned it.
    first, second : Skeleton
        The graphs that it is about.

    Returns
    -------
    tuple of str
        A sentence for each defect: several pieces, functions that differ by more, another Reeb graph.

    Raises
    ------
    TypeError
        If `found` is no result of `reeb_distance`, or a graph none of `reeb_graph`.

    Examples
    --------
    >>> import surfexp as sx
    >>> torus, sphere = sx.shape("torus"), sx.shape("icosphere", levels=3)
    >>> ring, chain = (sx.reeb_graph(one, one.mesh.vertices[:, 0]) for one in (torus, sphere))
    >>> found = sx.reeb_distance(ring, chain)
    >>> found.space
    <CommonSpace: common space of Reeb graphs, nodes 10, arcs 10, triangles 0, functions differ by 0.5997>
    >>> sx.check_reeb_distance(found, ring, chain)
    ()
    >>> sx.check_reeb_distance(found, ring, ring)
    ('its Reeb graph by the second function is not the second graph',)
    """
    if not isinstance(found, ReebDistance):
        raise TypeError(f"check_reeb_distance takes a result of sx.reeb_distance, not {type(found).__name__}")
    return common_space_defects(found.space, _graph(first), _graph(second), found.upper)


def _graph(graph: Skeleton) -> tuple[Floats, Integers]:
    if not isinstance(graph, Skeleton):
        raise TypeError(f"reeb_distance takes results of sx.reeb_graph, not {type(graph).__name__}")
    return graph.values, graph.arcs
