"""Faces to turn and winding numbers beside libigl, on 400 meshes in disorder."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.contract.arrays import Integers
from surfexp.mesh.orientation import flipped_faces, inconsistent_edges, turn_over, winding_number
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh

igl = pytest.importorskip("igl")
SOUND = (icosphere(1).mesh, icosphere(2).mesh, torus(12, 7).mesh)


def in_disorder(faces: Integers, random: np.random.Generator) -> Integers:
    faces = faces[random.random(len(faces)) < random.choice([0.5, 0.8, 1.0])]
    faces = turn_over(faces, random.random(len(faces)) < random.choice([0.05, 0.3, 0.5]))
    corners = (np.arange(3) + random.integers(0, 3, len(faces))[:, None]) % 3
    return faces[np.arange(len(faces))[:, None], corners][random.permutation(len(faces))]


def test_the_faces_to_turn_are_those_of_libigl() -> None:
    random = np.random.default_rng(0)
    for case in range(400):
        mesh = SOUND[case % 3]
        mesh = TriangleMesh(mesh.vertices, in_disorder(mesh.faces, random))
        oriented, patch = igl.bfs_orient(np.array(mesh.faces))
        turned = (oriented != mesh.faces).any(axis=1)
        share = np.bincount(patch, turned) / np.bincount(patch)
        found = flipped_faces(mesh)
        np.testing.assert_array_equal(found, turned != (share > 0.5)[patch])
        assert not inconsistent_edges(TriangleMesh(mesh.vertices, turn_over(mesh.faces, found))).any()


def test_a_strip_with_one_side_keeps_some_inconsistent_edges() -> None:
    around = np.arange(9)
    after, crossed = (around + 1) % 9, around == 8
    a, b = 2 * around, 2 * around + 1
    c, d = 2 * after + crossed, 2 * after + 1 - crossed
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])
    mesh = TriangleMesh(np.random.default_rng(0).normal(size=(18, 3)), faces)
    oriented = TriangleMesh(mesh.vertices, turn_over(faces, flipped_faces(mesh)))
    assert 1 <= inconsistent_edges(oriented).sum() <= 3


def test_meshes_without_shared_edges_have_nothing_to_turn() -> None:
    assert not flipped_faces(TriangleMesh(np.eye(3), np.array([[0, 1, 2]]))).any()
    assert flipped_faces(TriangleMesh(np.eye(3), np.empty((0, 3), np.int64))).shape == (0,)


def test_winding_numbers_are_those_of_libigl() -> None:
    points = 1.5 * np.random.default_rng(1).normal(size=(100, 3))
    for mesh in SOUND:
        expected = np.ravel(igl.winding_number(np.array(mesh.vertices), np.array(mesh.faces), points))
        found = [winding_number(mesh.vertices[mesh.faces], point) for point in points]
        np.testing.assert_allclose(found, expected, atol=1e-13)
