"""Edges, components, fans and copies by linear passes, against plain numpy and scipy on sound and broken meshes."""

from __future__ import annotations

from collections import Counter, defaultdict
from itertools import combinations, pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from surfexp.mesh.edge_table import edge_table
from surfexp.mesh.equal_rows import first_equal_row, later_copies
from surfexp.mesh.orientation import corner_fans
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.thin_faces import sharp_faces, zero_area_faces
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import SLIVER_DEGREES, validate
from surfexp.mesh.welding import weld

SOUND = [icosphere(1).mesh, icosphere(2).mesh, torus(9, 7).mesh, disk(rings=3).mesh]
MESHES = 1000
KINDS = {
    *("faces with a repeated index", "duplicate faces", "duplicate vertices", "unreferenced vertices"),
    *("non-manifold edges", "non-manifold vertices"),
}


def random_mesh(seed: int) -> TriangleMesh:
    """A soup of triangles, or a sound mesh with random faces lost, turned, doubled, welded and renumbered."""
    random = np.random.default_rng(seed)
    if seed % 5 == 0:
        count = int(random.integers(3, 12))
        points = random.integers(-1, 2, (count, 3)) * random.choice([0.0, 1.0, -1.0])
        return TriangleMesh(points, random.integers(0, count, (int(random.integers(1, 40)), 3)))
    mesh = SOUND[seed % len(SOUND)]
    vertices, faces = mesh.vertices.copy(), mesh.faces.copy()
    if seed % 5 == 1:
        faces = faces[random.random(len(faces)) < 0.8]
    if seed % 5 == 2:
        turned = random.random(len(faces)) < 0.1
        faces[turned] = faces[turned][:, ::-1]
        faces = np.concatenate([faces, np.roll(faces[random.integers(0, len(faces), 3)], 1, axis=1)])
    if seed % 5 == 3:
        corner = random.integers(0, faces.size, 6)
        faces.ravel()[corner] = random.integers(0, len(vertices), 6)
        vertices[random.integers(0, len(vertices), 4)] = vertices[random.integers(0, len(vertices), 4)]
    number = random.permutation(len(vertices))
    return TriangleMesh(vertices[np.argsort(number)], number[faces][random.permutation(len(faces))])


def components_by_scipy(links: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    graph = coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1])


def fans_by_scipy(mesh: TriangleMesh, crossable: NDArray[np.bool_]) -> NDArray[np.int64]:
    edge_of, links = mesh.face_edges.ravel(), []
    for edge in np.flatnonzero(crossable):
        here = np.flatnonzero(edge_of == edge)
        for first, second in pairwise(here):
            for end in (0, 1):
                left = 3 * (first // 3) + (first % 3 + end) % 3
                right = (
                    second if mesh.faces.flat[left] == mesh.faces.flat[second] else 3 * (second // 3) + (second + 1) % 3
                )
                links.append((left, right))
    return components_by_scipy(np.array(links).reshape(-1, 2), mesh.faces.size).reshape(-1, 3)


def copies_by_sets(rows: NDArray[np.generic]) -> list[bool]:
    seen: set[tuple[float, ...]] = set()
    copies = []
    for row in map(tuple, (rows + 0).tolist()):
        copies.append(row in seen)
        seen.add(row)
    return copies


def defects_by_dictionaries(mesh: TriangleMesh) -> Counter[str]:
    faces = mesh.faces.tolist()
    used = sorted({vertex for face in faces for vertex in face})
    found: Counter[str] = Counter()
    found["faces with a repeated index"] = sum(len(set(face)) < 3 for face in faces)
    found["duplicate faces"] = len(faces) - len({tuple(sorted(face)) for face in faces})
    found["duplicate vertices"] = len(used) - len(set(map(tuple, (mesh.vertices[used] + 0.0).tolist())))
    found["unreferenced vertices"] = len(mesh.vertices) - len(used)
    proper = [face for face in faces if len(set(face)) == 3]
    around: defaultdict[frozenset[int], list[int]] = defaultdict(list)
    at: defaultdict[int, list[int]] = defaultdict(list)
    for number, face in enumerate(proper):
        for pair in combinations(face, 2):
            around[frozenset(pair)].append(number)
        for vertex in face:
            at[vertex].append(number)
    found["non-manifold edges"] = sum(len(there) > 2 for there in around.values())
    for vertex, there in at.items():
        reached, front = {there[0]}, [there[0]]
        while front:
            sides = [pair for pair in combinations(proper[front.pop()], 2) if vertex in pair]
            near = {other for pair in sides for other in around[frozenset(pair)]} - reached
            reached |= near
            front += near
        found["non-manifold vertices"] += len(reached) < len(there)
    return +found


@pytest.mark.parametrize("part", range(10))
def test_every_answer_equals_the_one_by_sorting_rows(part: int) -> None:
    for seed in range(part * MESHES // 10, (part + 1) * MESHES // 10):
        mesh = random_mesh(seed)
        directed = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        edges, edge_of, counts = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True, return_counts=True)
        assert np.array_equal(mesh.edges, edges) and np.array_equal(mesh.face_edges.ravel(), edge_of.ravel())
        assert np.array_equal(mesh.edge_face_counts, counts)
        assert np.array_equal(mesh.edge_table.half_edges, np.argsort(edge_of.ravel(), kind="stable"))
        assert mesh.edges.dtype == mesh.face_edges.dtype == mesh.edge_face_counts.dtype == np.int64
        label = components_by_scipy(edges, len(mesh.vertices))
        assert np.array_equal(mesh.component_labels, label)
        assert mesh.component_count == len(np.unique(label[mesh.faces[:, 0]]))
        assert mesh.euler_characteristic == len(np.unique(mesh.faces)) - len(edges) + len(mesh.faces)
        for crossable in (np.ones(len(edges), dtype=bool), counts == 2):
            assert np.array_equal(corner_fans(mesh, crossable), fans_by_scipy(mesh, crossable))
        assert later_copies(mesh.vertices).tolist() == copies_by_sets(mesh.vertices)
        assert later_copies(np.sort(mesh.faces, axis=1)).tolist() == copies_by_sets(np.sort(mesh.faces, axis=1))


def test_a_mesh_is_judged_as_by_dictionaries() -> None:
    seen: Counter[str] = Counter()
    for seed in range(MESHES // 4):
        mesh = random_mesh(seed)
        report, expected = validate(mesh.vertices, mesh.faces), defects_by_dictionaries(mesh)
        judged = Counter({defect.kind: defect.count for defect in report.defects if defect.kind in KINDS})
        assert judged == expected, seed
        seen += expected
    assert set(seen) == KINDS and min(seen.values()) > 30


def test_thin_faces_are_those_of_the_plain_formulas() -> None:
    found = np.zeros(2, dtype=int)
    for seed in range(MESHES):
        mesh = random_mesh(seed)
        random = np.random.default_rng(seed)
        stretched = mesh.vertices * [1.0, 1.0, 10.0 ** -random.integers(0, 12)]
        mesh = TriangleMesh(stretched + 1e-3 * random.standard_normal(3), mesh.faces)
        corners = mesh.vertices[mesh.faces]
        sides = corners[:, [1, 2, 0]] - corners
        longest = (sides**2).sum(axis=2).max(axis=1)
        flat = mesh.areas <= 1e-9 * longest
        assert np.array_equal(zero_area_faces(mesh), flat)
        lengths = np.linalg.norm(sides, axis=2)
        products = np.maximum(lengths * lengths[:, [2, 0, 1]], 1e-300)
        sines = np.linalg.norm(np.cross(sides, sides[:, [2, 0, 1]]), axis=2) / products
        sharp = sines.min(axis=1) < np.sin(np.radians(SLIVER_DEGREES))
        assert np.array_equal(sharp_faces(mesh, SLIVER_DEGREES), sharp)
        found += flat.sum(), sharp.sum()
    assert found.min() > 1000


def test_half_edges_from_elsewhere_and_none_at_all() -> None:
    table = edge_table(np.array([3, 0, 2, 0]), np.array([1, 2, 0, 0]), 4)
    assert table.edges.tolist() == [[0, 0], [0, 2], [1, 3]] and table.edge_of.tolist() == [2, 1, 1, 0]
    assert table.half_edges.tolist() == [3, 1, 2, 0] and table.counts.tolist() == [1, 2, 1]
    none = edge_table(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), 3)
    assert none.edges.shape == (0, 2) and none.counts.shape == (0,)


def test_equal_rows_are_found_by_value() -> None:
    rows = np.array([[0.0, 1.0], [2.0, 3.0], [-0.0, 1.0], [2.0, 3.0], [1.0, 0.0], [np.nan, 1.0], [np.nan, 1.0]])
    assert first_equal_row(rows).tolist() == [0, 1, 0, 1, 4, 5, 5]
    assert first_equal_row(rows.astype(np.float32)).tolist() == [0, 1, 0, 1, 4, 5, 5]
    assert first_equal_row(np.array([[1], [2], [1]], dtype=np.int8)).tolist() == [0, 1, 0]
    assert len(first_equal_row(np.zeros((0, 3)))) == 0


def test_welded_corners_are_numbered_as_they_appear() -> None:
    for mesh in SOUND:
        vertices, faces = weld(mesh.vertices[mesh.faces])
        assert np.array_equal(vertices[faces], mesh.vertices[mesh.faces]) and len(vertices) == len(mesh.vertices)
        first_seen = [faces.ravel().tolist().index(number) for number in range(len(vertices))]
        assert first_seen == sorted(first_seen)
