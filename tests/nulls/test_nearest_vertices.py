"""Walks end at the vertex that a search through all of them finds, also where vertices coincide or share a circle."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.contract.arrays import Floats
from surfexp.nulls.nearest_vertices import NearestVertices
from surfexp.nulls.spins import random_rotations


def on_sphere(points: Floats) -> Floats:
    return np.asarray(points / np.linalg.norm(points, axis=1)[:, None])


def assert_nearest(directions: Floats, seed: int) -> None:
    nearest = NearestVertices.of(directions)
    for turn in random_rotations(3, seed):
        places = directions @ turn.T
        every = np.linalg.norm(places[:, None] - directions[None], axis=2)
        reached = every[np.arange(len(directions)), nearest.of_rotated(turn)]
        np.testing.assert_allclose(reached, every.min(axis=1), rtol=0, atol=1e-15)


@given(st.integers(0, 2**31), st.integers(4, 300), st.floats(1e-3, 1.0))
def test_of_scattered_points(seed: int, count: int, thickness: float) -> None:
    """Crowded about the equator as well as even."""
    points = np.random.default_rng(seed).standard_normal((count, 3)) * [1.0, 1.0, thickness]
    assert_nearest(on_sphere(points), seed)


def test_of_a_cube_and_of_rings_of_points_on_one_circle() -> None:
    cube = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    assert_nearest(on_sphere(cube), 0)
    angle, height = np.meshgrid(2 * np.pi * np.arange(24) / 24, np.linspace(-2.0, 2.0, 9))
    assert_nearest(on_sphere(np.stack([np.cos(angle), np.sin(angle), height], axis=2).reshape(-1, 3)), 1)


def test_vertices_that_coincide_have_a_nearest_one_as_well() -> None:
    points = on_sphere(np.random.default_rng(0).standard_normal((60, 3)))
    assert_nearest(np.concatenate([points, points[:20], points[:1]]), 2)


def test_of_a_part_of_a_sphere() -> None:
    points = np.random.default_rng(0).standard_normal((200, 3))
    points[:, 2] = np.abs(points[:, 2]) + 0.1
    assert_nearest(on_sphere(points), 3)


def test_the_identity_takes_each_vertex_to_itself() -> None:
    points = on_sphere(np.random.default_rng(0).standard_normal((500, 3)))
    np.testing.assert_array_equal(NearestVertices.of(points).of_rotated(np.eye(3)), np.arange(500))


def test_points_in_a_plane_are_refused() -> None:
    angle = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
    with pytest.raises(ValueError, match="12 vertices lie in a plane: give a sphere"):
        NearestVertices.of(np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1))
