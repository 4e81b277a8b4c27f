"""Rotations are uniform; the identity gives the map back; values come from the map or are unknown."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import kstest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.nulls.spins import mirrored, random_rotations, spin_sources, spun

SPHERE = 100.0 * icosphere(3).mesh.vertices
VALUES = np.random.default_rng(0).standard_normal(len(SPHERE))
IDENTITY = np.eye(3)[None]


def test_rotations_are_uniform() -> None:
    """The image of a point is uniform on the sphere, and the angle has the density (1 - cos a) / pi."""
    turns = random_rotations(4000, 3)
    np.testing.assert_allclose(turns @ turns.transpose(0, 2, 1), np.tile(np.eye(3), (4000, 1, 1)), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(turns), 1.0, rtol=1e-12)
    for k in range(9):
        assert kstest(turns.reshape(-1, 9)[:, k], "uniform", args=(-1.0, 2.0)).pvalue > 1e-3
    angles = Rotation.from_matrix(turns).magnitude()
    assert kstest(angles, lambda a: (a - np.sin(a)) / np.pi).pvalue > 1e-3
    np.testing.assert_array_equal(turns, random_rotations(4000, 3))
    assert not np.allclose(turns[0], random_rotations(1, 4)[0])


def test_the_identity_gives_the_map_back() -> None:
    np.testing.assert_array_equal(spun(VALUES, spin_sources(SPHERE, IDENTITY))[:, 0], VALUES)
    part = np.arange(100, 500)
    np.testing.assert_array_equal(spun(VALUES[part], spin_sources(SPHERE, IDENTITY, part))[:, 0], VALUES[part])


def test_a_symmetry_of_the_icosphere_permutes_the_map() -> None:
    half = np.diag([-1.0, -1.0, 1.0])[None]
    sources = spin_sources(SPHERE, half)[:, 0]
    np.testing.assert_allclose(SPHERE[sources], SPHERE @ half[0].T, atol=1e-12)
    assert len(np.unique(sources)) == len(SPHERE)


def test_values_are_of_the_map_and_unknown_where_they_come_from_outside() -> None:
    part = np.flatnonzero(SPHERE[:, 2] > -50.0)
    turns = random_rotations(40, 1)
    nulls = spun(VALUES[part], spin_sources(SPHERE, turns, part))
    known = np.isfinite(nulls)
    assert np.isin(nulls[known], VALUES[part]).all()
    # vertices whose rotated place is well outside or well inside
    height = np.einsum("rk,pk->pr", turns[:, 2], SPHERE[part])
    assert not known[height < -60.0].any() and known[height > -40.0].all()
    assert 0.2 < 1.0 - known.mean() < 0.3


def test_a_vertex_takes_the_value_of_the_one_nearest_to_its_rotated_place() -> None:
    turns = random_rotations(3, 2)
    sources = spin_sources(SPHERE, turns)
    for turn, column in zip(turns, sources.T, strict=True):
        every = np.linalg.norm((SPHERE @ turn.T)[:, None] - SPHERE[None], axis=2)
        np.testing.assert_array_equal(column, every.argmin(axis=1))


def test_the_other_hemisphere_is_spun_as_in_a_mirror() -> None:
    """A map on the mirrored sphere, spun by mirrored rotations, is the mirrored null."""
    turns, mirror = random_rotations(5, 7), np.array([-1.0, 1.0, 1.0])
    np.testing.assert_allclose(np.linalg.det(mirrored(turns)), 1.0)
    np.testing.assert_array_equal(spin_sources(SPHERE * mirror, mirrored(turns)), spin_sources(SPHERE, turns))


def test_what_is_no_sphere_is_refused() -> None:
    with pytest.raises(ValueError, match=r"vertices lie 9.* within 1% of each other is needed"):
        spin_sources(SPHERE + np.array([10.0, 0.0, 0.0]), IDENTITY)
    with pytest.raises(ValueError, match=r"part has 2 vertices, at least 1 in 0\.\.641"):
        spin_sources(SPHERE, IDENTITY, np.array([0, 642]))
    with pytest.raises(ValueError, match=r"part has 0 vertices"):
        spin_sources(SPHERE, IDENTITY, np.array([], dtype=np.int64))
    with pytest.raises(ValueError, match=r"map has shape \(5,\), the spins are of 642 vertices"):
        spun(VALUES[:5], spin_sources(SPHERE, IDENTITY))
