"""Problems solved on the sphere, on a grid and patch by patch, against the intrinsic solution."""

from __future__ import annotations

from functools import cache, partial

import numpy as np
import pytest
from excess_over_data import excess_over_data

from surfexp.baselines.conformal_flow import conformal_flow
from surfexp.baselines.energy_excess import energy_excess
from surfexp.baselines.parameter_domain import (
    Parametrized,
    conformal_domain,
    conformal_operator,
    image_mesh,
)
from surfexp.baselines.patchwise import disk_patches, patchwise_domain, seam_error, seam_vertices
from surfexp.baselines.sphere_grid import grid_separation, longitude_latitude_mesh, sphere_grid_domain
from surfexp.baselines.spherical_map import spherical_map
from surfexp.mesh.shapes.cup import cup
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.variational.separable_quadratic import convex_chan_vese, rof
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.solvers.split_bregman import split_bregman


def ellipsoid(levels):
    sphere = icosphere(levels).mesh
    return TriangleMesh(sphere.vertices * [1.0, 1.0, 1.8], sphere.faces)


def problem(mesh, seed=0):
    """Two phases bounded by smooth curves, noise of 0.3, length 3 edges."""
    operator, vertices = fem(mesh), mesh.vertices
    truth = np.sin(3 * vertices[:, 0]) + np.cos(2.5 * vertices[:, 1]) * np.sin(2 * vertices[:, 2] + 1) > 0.2
    image = truth + np.random.default_rng(seed).normal(0, 0.3, len(vertices))
    slope = ((1 - image) ** 2 - image**2) / (3 * mesh.edge_length)
    return operator, image, convex_chan_vese(operator.mass, slope)


ELLIPSOID = ellipsoid(4)
OPERATOR, IMAGE, FIDELITY = problem(ELLIPSOID)


@cache
def flowed():
    """The ellipsoid on the sphere after conformal flow."""
    return conformal_flow(ELLIPSOID, spherical_map(ELLIPSOID))


@cache
def reference():
    return primal_dual(FIDELITY, OPERATOR, tolerance=1e-6)


def test_conformal_weights_are_those_of_the_surface():
    """Areas to the digit, total variation as far as the map is conformal: its error falls with order 2."""
    errors = []
    for levels in (2, 3, 4):
        mesh = ellipsoid(levels)
        operator = conformal_operator(mesh, image_mesh(mesh, conformal_flow(mesh, spherical_map(mesh))))
        np.testing.assert_allclose(operator.mass, fem(mesh).mass, rtol=1e-12)
        height = np.sin(2 * mesh.vertices[:, 2]) + mesh.vertices[:, 0]
        errors.append(abs(total_variation(operator, height) / total_variation(fem(mesh), height) - 1))
    assert errors[-1] < 2e-4, errors
    assert np.log2(errors[0] / errors[-1]) / 2 > 1.5, errors


def test_a_similarity_changes_nothing():
    operator = conformal_operator(ELLIPSOID, TriangleMesh(3.0 * ELLIPSOID.vertices + 1.0, ELLIPSOID.faces))
    np.testing.assert_allclose(operator.hat_gradients, OPERATOR.hat_gradients, atol=1e-9)


@pytest.mark.parametrize(("positions", "bound"), [(flowed, 3e-4), (lambda: spherical_map(ELLIPSOID), 1e-3)])
def test_segmentation_on_the_sphere_matches_the_intrinsic_one(positions, bound):
    method = Parametrized(conformal_domain(ELLIPSOID, positions()), partial(primal_dual, tolerance=1e-4))
    solution = method(FIDELITY, OPERATOR)
    assert 0 < excess_over_data(FIDELITY, OPERATOR, solution.values, reference().lower_bound) < bound
    agreement = OPERATOR.mass @ ((solution.values > 0.5) == (reference().values > 0.5)) / OPERATOR.mass.sum()
    assert agreement > 0.99


def test_the_dual_field_of_the_sphere_certifies_on_the_surface():
    solution = Parametrized(conformal_domain(ELLIPSOID, flowed()), partial(primal_dual, tolerance=1e-5))(
        FIDELITY, OPERATOR
    )
    assert solution.lower_bound is not None and solution.lower_bound <= reference().energy
    assert solution.energy >= reference().lower_bound
    assert solution.relative_gap < 0.05
    again = Parametrized(conformal_domain(ELLIPSOID, flowed()), primal_dual)(FIDELITY, OPERATOR, solution)
    assert again.iterations <= 10 < solution.iterations


def test_rof_on_the_sphere_matches_the_intrinsic_one():
    fidelity = rof(OPERATOR.mass, IMAGE, 1 / (0.3 * ELLIPSOID.edge_length))
    intrinsic = primal_dual(fidelity, OPERATOR, tolerance=1e-5)
    solution = Parametrized(conformal_domain(ELLIPSOID, flowed()), partial(primal_dual, tolerance=1e-5))(
        fidelity, OPERATOR
    )
    difference = solution.values - intrinsic.values
    assert np.sqrt(OPERATOR.mass @ difference**2 / OPERATOR.mass.sum()) < 0.005
    assert solution.error_bound > np.sqrt(OPERATOR.mass @ difference**2) - intrinsic.error_bound


def test_the_grid_keeps_area_and_loses_energy_with_its_step():
    excesses = []
    for columns in (48, 96, 192):
        domain = sphere_grid_domain(ELLIPSOID, flowed(), columns, columns // 2)
        assert domain.metrics["area_ratio"] == pytest.approx(1, abs=0.01)
        constant = np.ones(len(ELLIPSOID.vertices))
        np.testing.assert_allclose(domain.to_vertices @ (domain.to_domain @ constant), 1, atol=1e-12)
        solution = Parametrized(domain, partial(split_bregman, tolerance=1e-3))(FIDELITY, OPERATOR)
        assert solution.lower_bound is None and solution.converged
        excesses.append(energy_excess(FIDELITY, OPERATOR, solution.values, reference().lower_bound))
    assert excesses[0] > 1.3 * excesses[1] > 1.3 * excesses[2] > 0, excesses


def test_grid_separation_counts_cells():
    grid = longitude_latitude_mesh(16, 8)
    assert (
        grid.is_closed
        and grid.genus == 0
        and (grid.face_normals * grid.vertices[grid.faces[:, 0]]).sum(axis=1).min() > 0
    )
    turn = np.pi / 16
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    centres = grid.vertices[:-2] @ rotation.T
    assert grid_separation(centres, 16, 8) == 1
    assert grid_separation(centres, 8, 8) == 0.5
    assert grid_separation(centres, 16, 4) == 0.5
    with pytest.raises(ValueError, match="at least 3 x 1"):
        longitude_latitude_mesh(2, 4)


@pytest.mark.parametrize("count", [1, 8, 20])
def test_patches_are_disks_that_cover_the_torus(count):
    mesh = torus(48, 24).mesh
    labels = disk_patches(mesh, count)
    assert np.array_equal(np.unique(labels), np.arange(labels.max() + 1)) and labels.max() + 1 >= count
    for label in range(labels.max() + 1):
        used, faces = np.unique(mesh.faces[labels == label], return_inverse=True)
        patch = TriangleMesh(mesh.vertices[used], faces.reshape(-1, 3))
        assert patch.euler_characteristic == 1 and patch.component_count == 1 and len(patch.boundary_loops) == 1


def test_patchwise_error_sits_at_the_seams():
    mesh = torus(96, 40).mesh
    operator, image, _ = problem(mesh)
    fidelity = rof(operator.mass, image, 1 / (0.3 * mesh.edge_length))
    intrinsic = primal_dual(fidelity, operator, tolerance=1e-6)
    labels = disk_patches(mesh, 8)
    domain = patchwise_domain(mesh, labels)
    assert domain.metrics["flipped_faces"] == 0
    assert domain.operator.mass.sum() == pytest.approx(mesh.area)
    solution = Parametrized(domain, partial(primal_dual, tolerance=1e-6))(fidelity, operator)
    measured = seam_error(mesh, labels, solution.values, intrinsic.values)
    assert measured["seam_error"] > 1.8 * measured["interior_error"], measured
    assert measured["seam_error_share"] > 1.7 * measured["seam_area_share"], measured
    assert energy_excess(fidelity, operator, solution.values, intrinsic.lower_bound) > 1e-3


def test_one_planar_patch_is_the_intrinsic_problem():
    """With no seam and no distortion nothing is lost."""
    mesh = longitude_latitude_mesh(20, 12)
    half = TriangleMesh(mesh.vertices * [1.0, 1.0, 0.0], mesh.faces[mesh.vertices[mesh.faces][:, :, 2].min(axis=1) > 0])
    used, faces = np.unique(half.faces, return_inverse=True)
    flat = TriangleMesh(half.vertices[used], faces.reshape(-1, 3))
    labels = np.zeros(len(flat.faces), dtype=np.int64)
    assert not seam_vertices(flat, labels).any()
    operator, _, fidelity = problem(flat)
    solution = Parametrized(patchwise_domain(flat, labels), partial(primal_dual, tolerance=1e-7))(fidelity, operator)
    assert solution.relative_gap < 1e-6


def test_bad_numbers_of_patches_are_refused():
    with pytest.raises(ValueError, match="number of patches is 0"):
        disk_patches(icosphere(1).mesh, 0)
    with pytest.raises(ValueError, match="takes one channel"):
        Parametrized(conformal_domain(ELLIPSOID, flowed()), primal_dual)(
            rof(OPERATOR.mass, ELLIPSOID.vertices, 1.0), OPERATOR
        )


@pytest.mark.slow
def test_patchwise_error_sits_at_the_seams_of_the_cup():
    mesh = cup(3000).mesh
    operator, _, fidelity = problem(mesh)
    intrinsic = primal_dual(fidelity, operator, tolerance=1e-5)
    labels = disk_patches(mesh, 10)
    domain = patchwise_domain(mesh, labels)
    solution = Parametrized(domain, primal_dual)(fidelity, operator)
    measured = seam_error(mesh, labels, solution.values, intrinsic.values)
    assert measured["seam_error"] > 1.5 * measured["interior_error"], measured
