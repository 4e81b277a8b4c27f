"""Distances to triangles in any dimension: against a quadratic programme, libigl in space, and under refinement."""

from __future__ import annotations

import igl
import numpy as np
import pytest
from embedded_clouds import cloud
from scipy.optimize import nnls

from surfexp.embedding.face_distance import distance_on_faces, distance_to_faces
from surfexp.embedding.nearest import nearest
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_surface import surface_elements
from surfexp.populations.disguise import disguise
from surfexp.spectrum.eigensolver import eigenpairs


def by_programme(point: np.ndarray, corners: np.ndarray) -> float:
    """Least |sum w_i c_i - p| over weights w >= 0 of sum 1, the sum held by a heavy row."""
    heavy = 1e5
    matrix = np.vstack([corners.T, heavy * np.ones(3)])
    weights = nnls(matrix, np.concatenate([point, [heavy]]))[0]
    return float(np.linalg.norm(weights @ corners / weights.sum() - point))


@pytest.mark.parametrize("n", [1, 2, 4, 9])
def test_a_triangle_in_many_dimensions(n: int) -> None:
    rng = np.random.default_rng(n)
    faces = np.array([[0, 1, 2]])
    for _ in range(40):
        corners, points = rng.normal(size=(3, n)), 1.5 * rng.normal(size=(5, n))
        expected = [by_programme(point, corners) for point in points]
        assert distance_to_faces(points, corners, faces) == pytest.approx(expected, abs=1e-5)


def test_triangles_without_area_are_segments_and_points() -> None:
    points = np.array([[0.5, 1.0, 0.0], [2.0, 0.0, 0.0]])
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.3, 0.0, 0.0]])
    assert distance_to_faces(points, line, np.array([[0, 1, 2]])) == pytest.approx([1.0, 1.0])
    assert distance_to_faces(points, line, np.array([[1, 1, 1]])) == pytest.approx([np.hypot(0.5, 1.0), 1.0])


def test_in_space_it_is_libigls_distance() -> None:
    mesh = icosphere(3).mesh
    stretched = np.array(mesh.vertices) * [1.0, 2.0, 0.2]
    points = np.random.default_rng(0).normal(size=(500, 3))
    expected = igl.point_mesh_squared_distance(points, stretched, np.array(mesh.faces))[0]
    assert distance_to_faces(points, stretched, mesh.faces) == pytest.approx(np.sqrt(expected), abs=1e-12)


def test_pruning_misses_nothing_on_slivers() -> None:
    rng = np.random.default_rng(3)
    vertices, points = cloud(6, 60, 1).points, cloud(6, 80, 2).points
    # long triangles whose corners are all far from where they are near
    faces = rng.integers(0, len(vertices), (90, 3))
    every = np.stack([distance_to_faces(points, vertices[face], np.array([[0, 1, 2]])) for face in faces])
    assert distance_to_faces(points, vertices, faces) == pytest.approx(every.min(axis=0), abs=1e-12)
    assert (distance_to_faces(points, vertices, faces) < nearest(points, vertices[np.unique(faces)])[1]).any()


def embed(surface: Surface, n: int):
    elements = surface_elements(surface.mesh)
    return spectral_embedding(eigenpairs(elements.stiffness, elements.mass, n + 1), surface.mesh.vertex_areas, n)


def test_to_faces_a_mesh_anew_is_nearer_and_the_gap_closes_under_refinement() -> None:
    gaps, ratios = [], []
    for levels in (2, 3, 4):
        surface = ellipsoid(levels, (1.0, 1.35, 0.7))
        other = disguise(surface, remeshed=True)
        first, second = embed(surface, 5), embed(other, 5)
        found = spectral_distance(first, second)
        on_faces = distance_on_faces(first, second.rotated(found.basis), surface.mesh.faces, other.mesh.faces)
        gaps.append(found.value - on_faces)
        ratios.append(on_faces / found.value)
    assert max(ratios) < 0.6
    assert gaps[2] < 0.7 * gaps[1] < 0.7 * 0.7 * gaps[0]


def test_unfit_surfaces_are_refused() -> None:
    ball = icosphere(1)
    elements = surface_elements(ball.mesh)
    matrices, areas = (elements.stiffness, elements.mass), elements.mass.sum(axis=0)
    points, faces = np.zeros((2, 3)), np.array([[0, 1, 2]])
    with pytest.raises(ValueError, match="the same number of columns"):
        distance_to_faces(points, np.zeros((3, 2)), faces)
    with pytest.raises(ValueError, match="at least 1 face is needed"):
        distance_to_faces(points, np.zeros((2, 3)), faces)
    one, other = (spectral_embedding(eigenpairs(*matrices, 9), areas, n) for n in (3, 5))
    with pytest.raises(ValueError, match=r"3 dimensions, .* against 5 dimensions"):
        distance_on_faces(one, other, ball.mesh.faces, ball.mesh.faces)
