"""The exact Reeb graph of a piecewise linear function: all its critical points, no sampling."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.vertex_star import vertex_stars
from surfexp.skeleton.adjacency import Flags, opposite_sides, pinched_vertices
from surfexp.skeleton.feature import checked_feature


@dataclass(frozen=True, eq=False)
class ReebGraph:
    """Critical points and the arcs between them.

    Parameters
    ----------
    vertices : (N,) int64
        The critical vertices, by rising value; equal values are told apart by the vertex number.
    values : (N,) float64
    arcs : (A, 2) int64
        Positions in `vertices`, lower before upper; two arcs may join the same pair.
    vertex_arcs : (n,) int64
        The arc whose contours pass through each vertex; at a critical vertex one of its arcs, -1 where no face is.
    """

    vertices: Integers
    values: Floats
    arcs: Integers
    vertex_arcs: Integers


def exact_reeb_graph(mesh: TriangleMesh, values: Floats) -> ReebGraph:
    """Sweep upward over the vertices and keep for every crossed edge the arc that its contour belongs to.

    Only above a critical vertex do contours change; those through it are walked, all others are left alone (in the spirit
    of minimal contouring: Patane, Spagnuolo and Falcidieno 2009). The cost is n log n and the lengths of the critical contours.

    Parameters
    ----------
    mesh : TriangleMesh
        Open or closed, of any number of components; at a vertex where fans of faces touch (a bow-tie) their contours meet.
    values : (n,) float64
        Vertices of one value are taken in the order of their numbers, everywhere alike.

    Raises
    ------
    ValueError
        If the values are unfit, or an edge has three faces; the message names the edge and the repair.
    """
    values = checked_feature(values, len(mesh.vertices))
    start, star = vertex_stars(mesh.faces, len(mesh.vertices))
    twins = opposite_sides(mesh)
    order = np.argsort(values, kind="stable")
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    pinched = pinched_vertices(mesh.faces, twins, start, star)
    nodes, arcs, vertex_arcs = _sweep(mesh.faces, twins, start, star, pinched, order, rank)
    return ReebGraph(nodes, values[nodes], arcs, vertex_arcs)


@njit(cache=True, nogil=True)
def _sweep(
    faces: Integers, twins: Integers, start: Integers, star: Integers, pinched: Flags, order: Integers, rank: Integers
) -> tuple[Integers, Integers, Integers]:
    # arcs are kept at the first of the two sides that make an edge
    side_arc = np.full(len(twins), -1, np.int64)
    nodes, arcs = np.empty(len(order), np.int64), np.empty((3 * len(order), 2), np.int64)
    vertex_arcs = np.full(len(order), -1, np.int64)
    seen = np.full(len(twins), -1, np.int64)
    node_count, arc_count = 0, 0
    for v in order:
        if start[v] == start[v + 1]:
            continue
        upper, lower, lowest_arc, several = 0, 0, -1, False
        for at in range(start[v], start[v + 1]):
            f = star[at]
            above = 0
            for k in range(3):
                a, b = faces[f, k], faces[f, (k + 1) % 3]
                if a != v and b != v:
                    above = (1 if rank[a] > rank[v] else 0) + (1 if rank[b] > rank[v] else 0)
                    continue
                side = 3 * f + k
                # an inner edge is met in two faces, one on the boundary in one
                weight = 2 if twins[side] < 0 else 1
                if rank[a + b - v] > rank[v]:
                    upper += weight
                else:
                    lower += weight
                    arc = side_arc[max(side, twins[side])]
                    if lowest_arc >= 0 and arc != lowest_arc:
                        several = True
                    lowest_arc = arc
            if above == 2:
                upper -= 2
            elif above == 0:
                lower -= 2
        # an extremum of one fan adds nothing to the counts of another
        regular = upper == 2 and lower == 2 and not pinched[v]
        if not regular:
            contours = _relabel(faces, twins, start, star, rank, v, side_arc, seen, arc_count, True)
            if contours == 1 and lowest_arc >= 0 and not several:
                # a single contour before and after: no node
                _relabel(faces, twins, start, star, rank, v, side_arc, seen, lowest_arc, False)
            else:
                for at in range(start[v], start[v + 1]):
                    for k in range(3):
                        side = 3 * star[at] + k
                        a, b = faces[star[at], k], faces[star[at], (k + 1) % 3]
                        if (a == v or b == v) and rank[a + b - v] < rank[v]:
                            arcs[side_arc[max(side, twins[side])], 1] = node_count
                for c in range(contours):
                    arcs[arc_count + c, 0] = node_count
                arc_count += contours
                nodes[node_count] = v
                node_count += 1
                lowest_arc = arc_count - 1 if contours else lowest_arc
        vertex_arcs[v] = lowest_arc
        if regular:
            for at in range(start[v], start[v + 1]):
                for k in range(3):
                    a, b = faces[star[at], k], faces[star[at], (k + 1) % 3]
                    if (a == v or b == v) and rank[a + b - v] > rank[v]:
                        side = 3 * star[at] + k
                        side_arc[max(side, twins[side])] = lowest_arc
    return nodes[:node_count].copy(), arcs[:arc_count].copy(), vertex_arcs


@njit(cache=True, nogil=True)
def _relabel(
    faces: Integers,
    twins: Integers,
    start: Integers,
    star: Integers,
    rank: Integers,
    v: int,
    side_arc: Integers,
    seen: Integers,
    arc: int,
    rising: bool,
) -> int:
    """Give the contours just above v the labels arc, arc + 1, ... (or all the same one); return how many there are."""
    level, count = rank[v], 0
    mark = 2 * level + (0 if rising else 1)
    for at in range(start[v], start[v + 1]):
        for k in range(3):
            first = 3 * star[at] + k
            a, b = faces[star[at], k], faces[star[at], (k + 1) % 3]
            edge = max(first, twins[first])
            if (a != v and b != v) or rank[a + b - v] <= level or seen[edge] == mark:
                continue
            label = arc + count if rising else arc
            seen[edge], side_arc[edge] = mark, label
            # from this edge both ways, through the face on either side
            for way in range(2):
                side = first if way == 0 else twins[first]
                while side >= 0:
                    f, onward = side // 3, -1
                    for j in range(3):
                        c, d = rank[faces[f, j]], rank[faces[f, (j + 1) % 3]]
                        if 3 * f + j != side and min(c, d) <= level < max(c, d):
                            onward = 3 * f + j
                    edge = max(onward, twins[onward])
                    if seen[edge] == mark:
                        break
                    seen[edge], side_arc[edge] = mark, label
                    side = twins[onward]
            count += 1
    return count
