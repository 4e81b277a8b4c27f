"""Initial curves: circles of the right radius, and angles that are geodesic distances on the sphere."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.variational.images.initial_curves import angular_distance, disc_distance


def test_one_disc_on_the_sphere_has_the_area_of_its_cap() -> None:
    mesh = icosphere(5).mesh
    inside = disc_distance(mesh, 1, 0.8, seed=3) > 0
    assert mesh.vertex_areas @ inside == pytest.approx(np.pi * 0.8**2, rel=0.02)


def test_the_same_seed_gives_the_same_discs_and_another_one_others() -> None:
    mesh = icosphere(3).mesh
    first = disc_distance(mesh, 4, 0.3, seed=1)
    assert np.array_equal(first, disc_distance(mesh, 4, 0.3, seed=1))
    assert not np.array_equal(first, disc_distance(mesh, 4, 0.3, seed=2))


@pytest.mark.parametrize(("discs", "radius"), [(0, 0.3), (163, 0.3), (1, 0.0), (1, 3.0)])
def test_impossible_discs_are_refused(discs: int, radius: float) -> None:
    with pytest.raises(ValueError, match=r"must lie in|are possible"):
        disc_distance(icosphere(2).mesh, discs, radius)


def test_angles_are_geodesic_distances_on_the_sphere() -> None:
    mesh = icosphere(3).mesh
    angles = angular_distance(mesh, np.array([0.0, 0.0, 2.0]))
    assert np.allclose(angles, np.arccos(np.clip(mesh.vertices[:, 2], -1, 1)), atol=1e-7)
    with pytest.raises(ValueError, match="direction"):
        angular_distance(mesh, np.zeros(3))
