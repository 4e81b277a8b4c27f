"""The narrow band holds exactly the nodes near the surface, with their true closest points."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.baselines.narrow_band import narrow_band
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere


def distance_to_triangles(points, mesh):
    """Brute force, independent of any tree: the least distance to the inside and the sides of each face."""
    best = np.full(len(points), np.inf)
    for face in mesh.faces:
        a, b, c = mesh.vertices[face]
        basis = np.stack([b - a, c - a], axis=1)
        s, t = np.linalg.lstsq(basis, (points - a).T, rcond=None)[0]
        plane = np.linalg.norm(points - a - np.stack([s, t], axis=1) @ basis.T, axis=1)
        best = np.minimum(best, np.where((s >= 0) & (t >= 0) & (s + t <= 1), plane, np.inf))
        for p, q in ((a, b), (b, c), (c, a)):
            along = np.clip((points - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1)
            best = np.minimum(best, np.linalg.norm(points - p - along[:, None] * (q - p), axis=1))
    return best


@pytest.mark.parametrize(("levels", "step"), [(1, 0.13), (0, 0.08)])
def test_closest_points_are_exact_and_the_band_is_complete(levels: int, step: float) -> None:
    """Faces of a few steps, whose nodes are those of their neighbours too, and of many."""
    mesh = icosphere(levels).mesh
    band = narrow_band(mesh, step, 2.5)
    everything = np.arange(np.prod(band.shape))
    points = band.origin + band.step * np.stack(np.unravel_index(everything, band.shape), axis=1)
    distance = distance_to_triangles(points, mesh)
    assert np.array_equal(np.flatnonzero(distance <= band.radius), band.keys)
    np.testing.assert_allclose(np.abs(band.distance), distance[band.keys], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(band.positions - band.closest, axis=1), np.abs(band.distance), atol=1e-12)
    assert np.array_equal(
        band.distance > 0, np.linalg.norm(band.positions, axis=1) > np.linalg.norm(band.closest, axis=1)
    )
    rebuilt = np.einsum("kc,kcd->kd", band.barycentric, mesh.vertices[band.corners])
    np.testing.assert_allclose(rebuilt, band.closest, atol=1e-12)
    np.testing.assert_allclose(band.extend(mesh.vertices[:, 1].copy()), band.closest[:, 1], atol=1e-12)


def test_distance_and_extension_on_the_sphere_converge():
    """Second order for the distance; first for the extension, for the closest point sees the normal of a flat face."""
    distance_errors, extension_errors = [], []
    for levels in (2, 3, 4):
        mesh = icosphere(levels).mesh
        band = narrow_band(mesh, 0.1, 2.5)
        positions = band.positions
        radius = np.linalg.norm(positions, axis=1)
        distance_errors.append(np.abs(band.distance - (radius - 1)).max())
        exact = np.sin(2 * positions[:, 2] / radius) + positions[:, 0] / radius
        vertices = mesh.vertices
        extension_errors.append(np.abs(band.extend(np.sin(2 * vertices[:, 2]) + vertices[:, 0]) - exact).max())
    for errors, order in ((distance_errors, 2), (extension_errors, 1)):
        rates = np.log2(np.array(errors[:-1]) / errors[1:])
        assert (rates > order - 0.2).all(), (errors, rates)


def test_neighbours_are_one_step_apart_and_mutual():
    band = narrow_band(icosphere(2).mesh, 0.1, 2.5)
    for axis in range(3):
        here = np.flatnonzero(band.forward[:, axis] >= 0)
        there = band.forward[here, axis]
        step = band.positions[there] - band.positions[here]
        np.testing.assert_allclose(step, np.broadcast_to(band.step * np.eye(3)[axis], step.shape), atol=1e-12)
        assert np.array_equal(band.backward[there, axis], here)
        assert (band.forward[:, axis] >= 0).sum() == (band.backward[:, axis] >= 0).sum()


def test_an_open_surface_has_a_band():
    mesh = disk(8).mesh
    band = narrow_band(mesh, 0.1, 2.0)
    inside = np.linalg.norm(band.positions[:, :2], axis=1) < 0.95
    np.testing.assert_allclose(np.abs(band.distance[inside]), np.abs(band.positions[inside, 2]), atol=1e-12)


def test_bad_sizes_are_refused():
    mesh = icosphere(1).mesh
    with pytest.raises(ValueError, match="grid step is 0"):
        narrow_band(mesh, 0.0, 2.0)
    with pytest.raises(ValueError, match="take a step of at least"):
        narrow_band(mesh, 1e-4, 2.0)
