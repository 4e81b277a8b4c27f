"""The distance of two Reeb graphs."""

from __future__ import annotations

from surfexp.mesh.given_numbers import whole_number
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
        `lower`, `upper`, and `proved` where they meet, in the unit of the maps; about the sampled graphs.

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
    for graph in (first, second):
        if not isinstance(graph, Skeleton):
            raise TypeError(f"reeb_distance takes results of sx.reeb_graph, not {type(graph).__name__}")
    return reeb_distance_bounds((first.values, first.arcs), (second.values, second.arcs), effort)
