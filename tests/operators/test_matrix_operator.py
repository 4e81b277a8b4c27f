"""Laplacians that are two matrices: what they must be, what works with them, what refuses them."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.calculus import gradient, total_variation
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.operators.matrix_operator import matrix_operator, robust_laplacian
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.surface_spectrum import elements_of, surface_spectrum
from surfexp.variational.image import Image
from surfexp.variational.models.rof import ROF
from surfexp.variational.solvers.chambolle_dual import chambolle_dual
from surfexp.variational.solvers.fista_dual import fista_dual
from surfexp.variational.solvers.gradient_descent import gradient_descent
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.solvers.split_bregman import split_bregman
from surfexp.variational.surface_flows import heat_flow

EXAMPLE = Path(__file__).resolve().parents[2] / "docs" / "inside" / "heat_kernel_laplacian.py"
SOLVERS = (primal_dual, split_bregman, chambolle_dual, fista_dual, gradient_descent, newton)


def pair_of(mesh: TriangleMesh) -> SurfaceOperator:
    """The finite elements of a mesh, handed over as matrices."""
    operator = fem(mesh)
    return matrix_operator(mesh, stiffness(operator), mass_matrix(operator), "pair")


@pytest.fixture(scope="module")
def sphere() -> Surface:
    return icosphere(3)


@pytest.mark.parametrize("mass", ["consistent", "lumped", "averaged"])
def test_a_pair_has_the_spectrum_of_the_elements_that_it_was_made_of(sphere: Surface, mass: str) -> None:
    pair, direct = (
        surface_spectrum(sphere, operator, 12, method="dense", mass=mass)  # type: ignore[arg-type]
        for operator in (pair_of(sphere.mesh), fem(sphere.mesh))
    )
    assert pair.values == pytest.approx(direct.values, abs=1e-10)
    assert pair.area == pytest.approx(sphere.mesh.area, rel=1e-12)


def test_dirichlet_values_of_a_pair_vanish_on_the_boundary() -> None:
    half = icosphere(2).mesh
    mesh = TriangleMesh(half.vertices, half.faces[(half.vertices[half.faces][:, :, 2] > -1e-9).all(axis=1)])
    used = np.unique(mesh.faces)
    mesh = TriangleMesh(mesh.vertices[used], np.searchsorted(used, mesh.faces))
    pair, direct = (
        elements_of(Surface(mesh), operator, boundary="dirichlet") for operator in (pair_of(mesh), fem(mesh))
    )
    assert np.array_equal(pair.free, direct.free) and len(pair.free) < len(mesh.vertices)
    assert abs(pair.stiffness - direct.stiffness).max() < 1e-12


def test_heat_flow_keeps_the_mean_and_agrees_with_the_elements(sphere: Surface) -> None:
    operator, values = fem(sphere.mesh), sphere.mesh.vertices[:, 0] ** 3
    lumped = matrix_operator(sphere.mesh, stiffness(operator), csr_array(diags_array(operator.mass)), "lumped pair")
    flowed = heat_flow(lumped, values, 0.1)
    assert flowed == pytest.approx(heat_flow(operator, values, 0.1), abs=1e-12)
    assert lumped.mass @ flowed == pytest.approx(lumped.mass @ values, abs=1e-12)


@pytest.mark.parametrize("solver", SOLVERS, ids=lambda solver: solver.__name__)
def test_methods_of_total_variation_refuse_a_pair_by_name(sphere: Surface, solver: object) -> None:
    image = Image(sphere.mesh.vertices[:, 2])
    said = (
        r"operator 'pair' is a pair of matrices without gradients, .*choose operator fem, intrinsic_delaunay, libigl$"
    )
    with pytest.raises(ValueError, match=said):
        ROF(mu=1.0).run(image, pair_of(sphere.mesh), solver)  # type: ignore[arg-type]


@pytest.mark.parametrize("function", [gradient, total_variation], ids=lambda function: function.__name__)
def test_gradients_of_a_pair_are_refused(sphere: Surface, function: object) -> None:
    with pytest.raises(ValueError, match="without gradients"):
        function(pair_of(sphere.mesh), sphere.mesh.vertices[:, 2])  # type: ignore[operator]
    with pytest.raises(ValueError, match="elements of order 2 of operator 'pair'"):
        elements_of(sphere, pair_of(sphere.mesh), order=2)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda L, M: (L[1:, 1:], M), r"stiffness of operator 'x' has shape \(641, 641\), the mesh has 642 vertices"),
        (lambda L, M: (L * np.nan, M), "stiffness of operator 'x' has entries that are not finite"),
        (lambda L, M: (-L, M), "on its diagonal: change its sign"),
        (lambda L, M: (L + M, M), "takes constants to .*, its rows must sum to 0"),
        (lambda L, M: (diags_array(1.0 + np.arange(642)) @ L, M), "must be symmetric"),
        (lambda L, M: (L, -M), "a row of the mass of operator 'x' sums to -.*, must be positive"),
    ],
)
def test_a_pair_that_is_no_laplacian_is_refused(sphere: Surface, change: object, said: str) -> None:
    operator = fem(sphere.mesh)
    first, second = change(stiffness(operator), mass_matrix(operator))  # type: ignore[operator]
    with pytest.raises(ValueError, match=said):
        matrix_operator(sphere.mesh, csr_array(first), csr_array(second), "x")


def test_the_tufted_laplacian_of_a_delaunay_sphere_is_the_cotangent_matrix(sphere: Surface) -> None:
    pytest.importorskip("robust_laplacian")
    operator, elements = robust_laplacian(sphere.mesh, mollify=0.0), fem(sphere.mesh)
    assert abs(stiffness(operator) - stiffness(elements)).max() < 1e-13
    assert operator.mass == pytest.approx(elements.mass, rel=1e-13)


def test_the_tufted_laplacian_of_slivers_is_that_of_the_intrinsic_delaunay_triangles() -> None:
    """The matrix is unique, where four corners lie on a circle too; areas are not, so masses may differ there."""
    pytest.importorskip("robust_laplacian")
    mesh = icosphere(3).mesh
    squashed = TriangleMesh(mesh.vertices * np.array([1.0, 1.0, 0.05]), mesh.faces)
    tufted = robust_laplacian(squashed, mollify=0.0)
    matrix = stiffness(tufted)
    assert abs(matrix - stiffness(intrinsic_delaunay(squashed))).max() < 1e-12
    assert abs(matrix - stiffness(fem(squashed))).max() > 1.0
    assert tufted.mass.sum() == pytest.approx(squashed.area, rel=1e-12)
    assert abs(matrix - matrix.T).max() == 0.0
    assert np.abs(matrix.sum(axis=1)).max() < 1e-12
    assert np.linalg.eigvalsh(matrix.toarray()).min() > -1e-12


def test_the_tufted_laplacian_converges_on_the_sphere() -> None:
    pytest.importorskip("robust_laplacian")
    exact = np.repeat([0.0, 2.0, 6.0], [1, 3, 5])
    errors = []
    for levels in (2, 3):
        surface = icosphere(levels)
        values = surface_spectrum(surface, robust_laplacian(surface.mesh), 9, method="dense").values
        errors.append(np.abs(values - exact).max())
    assert 1.8 < np.log2(errors[0] / errors[1]) < 2.2


def test_the_mesh_laplacian_of_the_example_has_the_eigenvalues_of_its_kernel() -> None:
    laplacian = runpy.run_path(str(EXAMPLE))["heat_kernel_laplacian"]
    t, errors = 0.1, []
    for levels in (2, 3):
        surface = icosphere(levels)
        values = surface_spectrum(surface, laplacian(surface.mesh, t), 9, method="dense").values
        exact = np.repeat([0.0, 2.0, 6.0 - 12.0 * t], [1, 3, 5])
        errors.append(np.abs(values - exact).max())
    assert errors[1] < 0.03 and 1.7 < np.log2(errors[0] / errors[1]) < 2.3


def test_the_matrices_that_were_given_keep_their_entries() -> None:
    """Unsorted rows in single precision: sorting indices in place would move the caller's entries."""
    mesh = icosphere(1).mesh
    mass = csr_array(mass_matrix(fem(mesh))).astype(np.float32)
    backwards = np.lexsort((-mass.indices, np.repeat(np.arange(mass.shape[0]), np.diff(mass.indptr))))
    mass = csr_array((mass.data[backwards], mass.indices[backwards], mass.indptr), shape=mass.shape)
    dense = mass.toarray()
    taken = matrix_operator(mesh, stiffness(fem(mesh)), mass, "pair").matrices
    assert taken is not None
    np.testing.assert_array_equal(mass.toarray(), dense)
    np.testing.assert_array_equal(taken[1].toarray(), dense)
