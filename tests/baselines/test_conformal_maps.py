"""Conformal maps to the sphere and the plane: rates of the angle error, no flips, exact distortion of known maps."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.baselines.conformal_flow import conformal_flow
from surfexp.baselines.disk_map import disk_map
from surfexp.baselines.distortion import corner_angles, distortion, length_scale, quasi_conformal_dilatation
from surfexp.baselines.parameter_domain import image_mesh
from surfexp.baselines.spherical_map import spherical_map
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import stiffness
from surfexp.operators.fem import fem

ORIGIN = np.zeros(3)


def ellipsoid(levels):
    sphere = icosphere(levels).mesh
    return TriangleMesh(sphere.vertices * [1.0, 1.0, 1.8], sphere.faces)


def rates(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_a_sphere_comes_back_as_a_moebius_map():
    """Centred, that is a rotation: angles of the linear map converge with order 1, the flow mends them at once."""
    angles, distances = [], []
    for levels in (2, 3, 4):
        mesh = icosphere(levels).mesh
        image = spherical_map(mesh)
        measured = distortion(mesh, image_mesh(mesh, image), ORIGIN)
        assert measured["flipped_faces"] == 0
        angles.append(measured["angle_error_mean"])
        left, _, right = np.linalg.svd(image.T @ mesh.vertices)
        distances.append(mesh.vertex_areas @ np.linalg.norm(image @ (left @ right) - mesh.vertices, axis=1) / mesh.area)
        assert np.linalg.det(left @ right) > 0
        flowed = distortion(mesh, image_mesh(mesh, conformal_flow(mesh, image)), ORIGIN)
        assert (
            flowed["angle_error_max"] < 0.05 and flowed["length_scale_ratio"] < 1.002 and flowed["flipped_faces"] == 0
        )
    assert (rates(angles) > 0.7).all(), angles
    assert (rates(distances) > 0.9).all(), distances


def conformality_defect(mesh: TriangleMesh, positions: np.ndarray) -> float:
    """Dirichlet energy over area, minus 1, of a piecewise linear map: 0 for a conformal one, positive for any other."""
    energy = 0.5 * float(np.einsum("nd,nd->", positions, stiffness(fem(mesh)) @ positions))
    return energy / TriangleMesh(positions, mesh.faces).area - 1.0


def test_angle_error_on_an_ellipsoid_is_of_first_order():
    worst, defects = [], []
    for levels in (2, 3, 4):
        mesh = ellipsoid(levels)
        image = conformal_flow(mesh, spherical_map(mesh))
        measured = distortion(mesh, image_mesh(mesh, image), ORIGIN)
        assert measured["flipped_faces"] == 0
        assert np.linalg.norm(mesh.vertex_areas @ image / mesh.area) < 1e-9
        worst.append(measured["angle_error_max"])
        defects.append(conformality_defect(mesh, image))
    assert (rates(worst) > 0.9).all(), worst
    assert (rates(defects) > 1.8).all() and min(defects) > 0, defects


def test_the_flow_finds_the_same_map_from_the_surface_as_from_the_linear_map():
    """Two routes to the centred conformal map, which is unique up to rotation: lengths must scale alike."""
    mesh = ellipsoid(3)
    routes = [
        length_scale(mesh, image_mesh(mesh, conformal_flow(mesh, start))) for start in (None, spherical_map(mesh))
    ]
    np.testing.assert_allclose(routes[0], routes[1], rtol=0.02)


def test_only_spheres_are_mapped_to_the_sphere():
    with pytest.raises(ValueError, match="genus 1"):
        spherical_map(torus(12, 8).mesh)
    with pytest.raises(ValueError, match="1 boundary loops"):
        conformal_flow(disk(3).mesh)


@pytest.mark.parametrize("boundary", ["free", "circle"])
def test_a_flat_disk_comes_back_as_itself(boundary):
    mesh = disk(6).mesh
    plane = disk_map(mesh, boundary)
    measured = distortion(mesh, image_mesh(mesh, plane))
    assert measured["flipped_faces"] == 0
    assert measured["angle_error_max"] < (1e-6 if boundary == "free" else 2.0)
    assert measured["length_scale_ratio"] == pytest.approx(1, abs=1e-6 if boundary == "free" else 0.05)


def test_a_cap_is_mapped_conformally():
    worst = []
    for rings in (6, 12, 24):
        flat = disk(rings).mesh
        colatitude = 1.2 * np.linalg.norm(flat.vertices[:, :2], axis=1, keepdims=True)
        direction = flat.vertices[:, :2] / np.maximum(colatitude / 1.2, 1e-300)
        cap = TriangleMesh(np.hstack([np.sin(colatitude) * direction, np.cos(colatitude)]), flat.faces)
        measured = distortion(cap, image_mesh(cap, disk_map(cap)))
        assert measured["flipped_faces"] == 0
        worst.append(measured["angle_error_max"])
    assert (rates(worst) > 0.8).all(), worst


def test_only_disks_are_mapped_to_the_plane():
    with pytest.raises(ValueError, match="Euler characteristic 2"):
        disk_map(icosphere(1).mesh)


def test_distortion_of_known_linear_maps():
    mesh = disk(4).mesh
    stretched = TriangleMesh(mesh.vertices * [2.0, 1.0, 1.0], mesh.faces)
    np.testing.assert_allclose(quasi_conformal_dilatation(mesh, stretched), 2.0, rtol=1e-9)
    np.testing.assert_allclose(length_scale(mesh, stretched), np.sqrt(2.0))
    mirrored = TriangleMesh(mesh.vertices * [1.0, -3.0, 1.0], mesh.faces)
    measured = distortion(mesh, mirrored)
    assert measured["flipped_faces"] == len(mesh.faces)
    assert measured["quasi_conformal_mean"] == pytest.approx(3.0)
    scaled = distortion(mesh, TriangleMesh(mesh.vertices * 5.0, mesh.faces))
    assert scaled["angle_error_max"] == pytest.approx(0, abs=1e-5)
    assert scaled["length_scale_spread"] == pytest.approx(1)
    np.testing.assert_allclose(corner_angles(mesh).sum(axis=1), np.pi)
