"""Reeb graphs of complexes that are pinched at vertices, against brute force; at edges of three faces they are refused."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.mesh.orientation import corner_fans, fans_per_vertex
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import arc_components

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


class Pieces:
    """Disjoint sets of anything hashable, as a dictionary of parents."""

    def __init__(self) -> None:
        self.parent: dict = {}

    def root(self, item):
        self.parent.setdefault(item, item)
        while self.parent[item] != item:
            item = self.parent[item]
        return item

    def join(self, first, second) -> None:
        self.parent[self.root(first)] = self.root(second)

    def count(self) -> int:
        return sum(item == parent for item, parent in self.parent.items())


def brute_force_arcs(faces: np.ndarray, values: np.ndarray) -> Counter:
    """Arcs of the Reeb graph by their end vertices, from the components of every level set and of what lies between.

    Level sets at and between all vertices are cut out of every face, joined by their common points, and a component with
    one neighbour below and one above is no node.
    """
    rank = np.argsort(np.argsort(values, kind="stable"))
    faces, count = rank[faces], len(values)
    pieces = Pieces()
    # position 2 r is the level of the vertex of rank r, 2 r + 1 lies between it and the next
    for position in range(2 * count - 1):
        for face in faces:
            low, middle, high = sorted(face)
            crossed = [(a, b) for a, b in ((low, middle), (middle, high), (low, high)) if 2 * a < position < 2 * b]
            points = crossed + [(v, v) for v in face if 2 * v == position]
            for point in points:
                pieces.join((position, points[0]), (position, point))
    above, below = {}, {}
    for position in range(2 * count - 2):
        for face in faces:
            for a in face:
                for b in face:
                    here, there = 2 * a <= position <= 2 * b, 2 * a <= position + 1 <= 2 * b
                    if a < b and here and there:
                        lower = pieces.root((position, (a, a) if 2 * a == position else (a, b)))
                        upper = pieces.root((position + 1, (b, b) if 2 * b == position + 1 else (a, b)))
                        above.setdefault(lower, set()).add(upper)
                        below.setdefault(upper, set()).add(lower)
    nodes = {
        p for p in {pieces.root(p) for p in pieces.parent} if len(above.get(p, ())) != 1 or len(below.get(p, ())) != 1
    }
    order = np.argsort(rank)
    arcs: Counter = Counter()
    for node in nodes:
        for place in above.get(node, ()):
            while place not in nodes:
                (place,) = above[place]
            arcs[int(order[node[0] // 2]), int(order[place[0] // 2])] += 1
    return arcs


def exact_arcs(faces: np.ndarray, values: np.ndarray) -> Counter:
    graph = exact_reeb_graph(mesh_of(faces, len(values)), values)
    return Counter(map(tuple, graph.vertices[graph.arcs].tolist()))


def mesh_of(faces: np.ndarray, count: int) -> TriangleMesh:
    return TriangleMesh(np.random.default_rng(0).normal(size=(count, 3)), faces)


def edge_counts(faces) -> Counter:
    return Counter(tuple(sorted((face[k], face[k - 1]))) for face in faces for k in range(3))


def pinches(faces: np.ndarray) -> int:
    mesh = mesh_of(faces, faces.max() + 1)
    return int((fans_per_vertex(mesh, corner_fans(mesh, mesh.edge_face_counts == 2)) > 1).sum())


@st.composite
def complexes(draw, most_faces_at_an_edge: int):
    """Random triangles on few vertices, taken as long as no edge has too many: bow-ties nearly everywhere."""
    count = draw(st.integers(5, 9))
    seed = draw(st.integers(0, 10**9))
    rng = np.random.default_rng(seed)
    triples = [tuple(rng.permutation(count)[:3].tolist()) for _ in range(draw(st.integers(3, 40)))]
    kept, sides, seen = [], Counter(), set()
    for triple in triples:
        edges = edge_counts([triple])
        if frozenset(triple) not in seen and all(sides[e] < most_faces_at_an_edge for e in edges):
            kept.append(triple)
            seen.add(frozenset(triple))
            sides += edges
    used, faces = np.unique(np.array(kept), return_inverse=True)
    return faces.reshape(-1, 3), rng.permutation(len(used)).astype(float)


@settings(max_examples=300)
@given(complexes(2))
def test_exact_graphs_of_pinched_complexes_are_those_of_brute_force(found):
    faces, values = found
    assert exact_arcs(faces, values) == brute_force_arcs(faces, values)


@settings(max_examples=100)
@given(st.integers(1, 5), st.integers(0, 10**9))
def test_tetrahedra_that_share_vertices_are_graphs_of_brute_force(count, seed):
    """Closed pieces joined at single vertices: counts of neighbours alone cannot see where they touch."""
    rng = np.random.default_rng(seed)
    faces = np.concatenate([TETRAHEDRON + 4 * k for k in range(count)])
    names = np.arange(4 * count)
    for k in range(1, count):
        names[4 * k + rng.integers(4)] = rng.integers(4 * k)
    used, faces = np.unique(names[faces], return_inverse=True)
    faces, values = faces.reshape(-1, 3), rng.permutation(len(used)).astype(float)
    assert pinches(faces) >= (count > 1)
    assert exact_arcs(faces, values) == brute_force_arcs(faces, values)
    sampled = reeb_graph(mesh_of(faces, len(used)), values, np.array([0.4, 0.6]) * len(used))
    assert sampled.metrics["b1"] + sampled.metrics["hidden_handles"] == 0


@settings(max_examples=100)
@given(complexes(2), st.integers(0, 10**6))
def test_loops_of_a_sampled_graph_of_a_pinched_complex(found, seed):
    """At levels between all vertices nothing is hidden: loops and pieces are those of brute force."""
    faces, values = found
    arcs = brute_force_arcs(faces, values)
    ends = np.array(list(arcs.elements()))
    pieces = arc_components(np.unique(ends, return_inverse=True)[1].reshape(-1, 2), len(np.unique(ends)))
    loops = len(ends) - len(np.unique(ends)) + pieces
    every = reeb_graph(mesh_of(faces, len(values)), values, np.arange(len(values) - 1) + 0.5)
    assert (every.metrics["components"], every.metrics["b1"]) == (pieces, loops)
    some = np.sort(np.random.default_rng(seed).choice(len(values) - 1, 2, replace=False)) + 0.5
    sampled = reeb_graph(mesh_of(faces, len(values)), values, some)
    if max(edge_counts(faces).values()) == 2 == min(edge_counts(faces).values()):
        assert sampled.metrics["b1"] + sampled.metrics["hidden_handles"] == loops


def test_the_random_complexes_are_pinched_and_branch():
    rng = np.random.default_rng(1)
    touching = np.concatenate([TETRAHEDRON, np.array([3, 4, 5, 6])[TETRAHEDRON]])
    assert pinches(touching) == 1
    for _ in range(20):
        values = rng.permutation(7).astype(float)
        assert exact_arcs(touching, values) == brute_force_arcs(touching, values)
    # one tetrahedron hangs from the side of the other: a contour is born at the point where they touch
    assert exact_arcs(touching, np.array([0.0, 2.0, 3.0, 1.0, 4.0, 5.0, 6.0])) == {(0, 3): 1, (3, 2): 1, (3, 6): 1}


@settings(max_examples=60)
@given(complexes(4))
def test_an_edge_of_three_faces_is_refused_by_its_name_with_the_repair(found):
    faces, values = found
    worst = max(edge_counts(faces).values())
    if worst <= 2:
        return
    for graph in (exact_reeb_graph, lambda m, v: reeb_graph(m, v, np.array([0.5]))):
        with pytest.raises(
            ValueError, match=r"edge between vertices \d+ and \d+ has \d+ faces, at most 2.*surfexp repair"
        ):
            graph(mesh_of(faces, len(values)), values)
