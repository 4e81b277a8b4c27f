"""Edges without length are contracted: a surface with doubled vertices becomes the one that it was made of."""

from __future__ import annotations

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.repair import repair
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.zero_edges import contract_zero_edges

BALL = sx.shape("icosphere", levels=2).mesh
CAP = TriangleMesh(BALL.vertices, BALL.faces[BALL.vertices[BALL.faces].mean(axis=1)[:, 2] > -0.4])


def ring(faces: list[list[int]], vertex: int) -> list[tuple[int, int]]:
    """The sides opposite to a vertex, one behind the other; of an open fan from its beginning."""
    after = {}
    for face in faces:
        if vertex in face:
            k = face.index(vertex)
            after[face[(k + 1) % 3]] = face[(k + 2) % 3]
    start = next(iter(set(after) - set(after.values())), min(after))
    found = []
    while start in after and len(found) < len(after):
        found.append((start, after[start]))
        start = after[start]
    return found


def doubled(mesh: TriangleMesh, chosen: list[int], free: bool = False) -> TriangleMesh:
    """Split vertices: a copy at the same place takes two faces of the fan, and needles join it to the vertex."""
    points, faces = mesh.vertices.tolist(), mesh.faces.tolist()
    for vertex in chosen:
        sides = ring(faces, vertex)[:2]
        copy = len(points)
        points.append(points[vertex])
        for a, b in sides:
            face = next(f for f in faces if set(f) == {vertex, a, b})
            face[face.index(vertex)] = copy
        first, last = sides[0][0], sides[1][1]
        if not free:
            faces.append([vertex, first, copy])
        faces.append([vertex, copy, last])
    return TriangleMesh(np.array(points), np.array(faces))


def as_set(faces: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(np.roll(face, -int(np.argmin(face))).tolist()) for face in faces}


@pytest.mark.parametrize("count", [1, 12, 40])
def test_doubled_vertices_of_a_closed_surface_are_undone(count: int) -> None:
    chosen = np.random.default_rng(count).permutation(len(BALL.vertices))[:count].tolist()
    given = doubled(BALL, chosen)
    changes: list[str] = []
    assert as_set(contract_zero_edges(given, changes)) == as_set(BALL.faces)
    assert changes == [f"merged, because an edge without length joined them: {count} vertices"]
    mended = repair(given.vertices, given.faces)
    assert mended.mesh.component_count == 1 and not mended.mesh.boundary_loops
    assert mended.mesh.area == pytest.approx(BALL.area, rel=1e-15)


def test_doubled_vertices_on_a_boundary_are_undone() -> None:
    rim = [loop[0] for loop in CAP.boundary_loops][:1]
    for free in (False, True):
        chosen = rim if free else [int(np.argmax(CAP.vertices[:, 2]))]
        given = doubled(CAP, chosen, free)
        mended = repair(given.vertices, given.faces).mesh
        assert len(mended.boundary_loops) == 1 and mended.component_count == 1
        assert as_set(contract_zero_edges(given, [])) == as_set(CAP.faces)


def test_a_sphere_of_a_grid_has_one_vertex_at_each_pole() -> None:
    """As VTK and pyvista make it: the rows at the poles are twenty vertices at one place, and needles between them."""
    rows, columns = 12, 20
    theta, phi = np.linspace(0, np.pi, rows), np.linspace(0, 2 * np.pi, columns, endpoint=False)
    points = np.stack(
        [
            np.outer(np.sin(theta), np.cos(phi)),
            np.outer(np.sin(theta), np.sin(phi)),
            np.outer(np.cos(theta), np.ones(columns)),
        ],
        axis=2,
    )
    points[-1, :, :2] = 0.0
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b = number[:-1], np.roll(number, -1, axis=1)[:-1]
    c, d = number[1:], np.roll(number, -1, axis=1)[1:]
    faces = np.concatenate([np.stack([a, c, b], axis=2).reshape(-1, 3), np.stack([b, c, d], axis=2).reshape(-1, 3)])
    mended = repair(points.reshape(-1, 3), faces)
    mesh = mended.mesh
    assert len(mesh.vertices) == (rows - 2) * columns + 2 and len(mesh.faces) == 2 * (rows - 2) * columns
    assert mesh.component_count == 1 and not mesh.boundary_loops and mesh.genus == 0
    surface = sx.repair((points.reshape(-1, 3), faces))
    values = sx.eigenpairs(surface, 4).values
    np.testing.assert_allclose(values, sx.eigenpairs(mesh, 4).values, rtol=1e-9, atol=1e-12)
    assert values[1:] == pytest.approx(2.0, rel=0.05)


def test_results_stand_at_both_ends_of_an_edge_without_length(tmp_path) -> None:  # type: ignore[no-untyped-def]
    given = doubled(BALL, [3, 40, 77])
    surface = sx.repair((given.vertices, given.faces))
    smoothed = sx.smooth(surface, given.vertices[:, 2], 0.4)
    sx.write(tmp_path / "a.npy", smoothed, surface)
    found = np.load(tmp_path / "a.npy")
    np.testing.assert_allclose(found, np.r_[found[:162], found[[3, 40, 77]]], rtol=0, atol=0)
    np.testing.assert_allclose(found[:162], sx.smooth(BALL, BALL.vertices[:, 2], 0.4).values, rtol=1e-12, atol=1e-14)


def test_a_neck_is_not_pinched() -> None:
    """An edge without length from one boundary to the other of a ring, with its two needles, is left to the flips."""
    turn = 2 * np.pi * np.arange(8) / 8
    inner, outer = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1), None
    outer = 2.0 * inner
    outer[0] = inner[0]
    k, after = np.arange(8), (np.arange(8) + 1) % 8
    faces = np.concatenate([np.stack([k, k + 8, after], axis=1), np.stack([after, k + 8, after + 8], axis=1)])
    changes: list[str] = []
    np.testing.assert_array_equal(contract_zero_edges(TriangleMesh(np.r_[inner, outer], faces), changes), faces)
    assert not changes


def test_a_flat_tetrahedron_does_not_fold() -> None:
    points = np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0], [0, 1, 0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    np.testing.assert_array_equal(contract_zero_edges(TriangleMesh(points, faces), []), faces)


def test_a_tube_of_three_corners_is_not_closed() -> None:
    """The ends of the edge have a third neighbour in common around the tube: one vertex would be left of three."""
    turn = 2 * np.pi * np.arange(3) / 3
    points = np.array([[np.cos(t), np.sin(t), z] for z in range(5) for t in turn])
    points[7] = points[6]
    k = np.arange(12)
    after = np.where(k % 3 == 2, k - 2, k + 1)
    faces = np.concatenate([np.stack([k, after, k + 3], axis=1), np.stack([after, after + 3, k + 3], axis=1)])
    np.testing.assert_array_equal(contract_zero_edges(TriangleMesh(points, faces), []), faces)
