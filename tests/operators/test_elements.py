"""Finite elements of order 1 to 3: identities, exact spectra, and the rates at which they are reached."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import jn_zeros, jnp_zeros

from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import flat_torus, rectangle
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.elements_lagrange import lagrange_element
from surfexp.operators.elements_nodes import flat_positions, number_nodes
from surfexp.operators.elements_surface import assemble_elements, surface_elements
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensolver import eigenpairs

SPHERE = np.array([degree * (degree + 1.0) for degree in range(10) for _ in range(2 * degree + 1)])


def onto_sphere(points: np.ndarray) -> np.ndarray:
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def onto_circle(points: np.ndarray) -> np.ndarray:
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def sphere_error(order: int, levels: int, degree: int, curved: bool = True, **options) -> float:
    elements = surface_elements(icosphere(levels).mesh, order, onto_sphere if curved else None, **options)
    k = (degree + 1) ** 2
    values = eigenpairs(elements.stiffness, elements.mass, k, tolerance=1e-9).values
    return float(np.abs(values[1:] / SPHERE[1:k] - 1.0).max())


def rate(errors: list[float]) -> float:
    return float(np.log2(errors[-2] / errors[-1]))


@pytest.mark.parametrize("order", [1, 2, 3])
def test_basis_is_a_partition_of_unity_and_nodal(order: int) -> None:
    element = lagrange_element(order)
    assert element.weights.sum() == pytest.approx(0.5, abs=1e-15)
    assert np.allclose(element.basis.sum(axis=1), 1.0, atol=1e-13)
    assert np.allclose(element.gradients.sum(axis=1), 0.0, atol=1e-12)
    # the quadrature integrates x^i y^j to i! j! / (i + j + 2)!, and the basis reproduces it
    x, y = element.points.T
    nodal = element.nodes[:, 1] ** order
    assert element.weights @ (element.basis @ nodal) == pytest.approx([1 / 6, 1 / 12, 1 / 20][order - 1], rel=1e-13)
    assert element.weights @ (x**3 * y**2) == pytest.approx(12.0 / 5040.0, rel=1e-13)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_stiffness_and_mass_are_exact_on_polynomials(order: int) -> None:
    mesh = rectangle(7, 5, 1.5, 1.0).mesh
    elements = surface_elements(mesh, order)
    nodes = elements.nodes
    positions = np.zeros((nodes.count, 3))
    positions[nodes.connectivity] = flat_positions(mesh.vertices[mesh.faces], order)
    x, y = positions[:, 0], positions[:, 1]
    f = x**order + y
    energy = order**2 * 1.5 ** (2 * order - 1) / (2 * order - 1) + 1.5
    assert f @ (elements.stiffness @ f) == pytest.approx(energy, rel=1e-12)
    assert elements.mass.sum() == pytest.approx(1.5, rel=1e-13) and elements.area == pytest.approx(1.5, rel=1e-13)
    assert x @ (elements.mass @ x) == pytest.approx(1.5**3 / 3.0, rel=1e-12)
    assert np.abs(elements.stiffness @ np.ones(nodes.count)).max() < 1e-11
    assert len(nodes.boundary) == order * 20


def test_order_one_equals_the_cotangent_matrices() -> None:
    mesh = icosphere(2).mesh
    operator, elements = fem(mesh), surface_elements(mesh)
    assert abs(elements.stiffness - stiffness(operator)).max() < 1e-13
    assert abs(elements.mass - mass_matrix(operator)).max() < 1e-14
    lumped = surface_elements(mesh, mass="lumped").mass
    assert np.allclose(lumped.diagonal(), operator.mass, rtol=1e-12) and lumped.nnz == len(mesh.vertices)


@pytest.mark.parametrize(("order", "expected"), [(1, 2.0), (2, 4.0), (3, 4.0)])
def test_rates_on_the_curved_sphere(order: int, expected: float) -> None:
    # order 3 is held back by its geometry, h^4; order 2 gains one power from symmetry
    errors = [sphere_error(order, levels, 3) for levels in ((2, 3, 4) if order == 1 else (2, 3))]
    assert rate(errors) == pytest.approx(expected, abs=0.3), errors


def test_order_three_has_its_full_rate_where_the_function_is_the_harder_part() -> None:
    errors = [sphere_error(3, levels, 9) for levels in (2, 3)]
    assert rate(errors) > 5.5, errors


def test_high_order_gains_nothing_on_flat_facets_of_the_sphere() -> None:
    errors = [sphere_error(2, levels, 3, curved=False) for levels in (2, 3)]
    assert rate(errors) == pytest.approx(2.0, abs=0.2)
    assert errors[-1] > 20 * sphere_error(2, 3, 3)


def test_published_accuracy_on_the_sphere() -> None:
    assert sphere_error(2, 3, 4) <= 2e-4
    assert sphere_error(3, 3, 4) <= 5e-6


def test_averaged_mass_is_ten_times_better_at_middle_modes() -> None:
    faces, corners = flat_torus(40)
    side = float(np.sqrt(surface_area(corners)))
    nodes = number_nodes(faces, 1600, 1)
    exact = torus_values(side)[:60]
    errors = {}
    for mass in ("consistent", "lumped", "averaged"):
        elements = assemble_elements(nodes, corners, mass)
        values = eigenpairs(elements.stiffness, elements.mass, 60).values
        errors[mass] = np.abs(values[1:] / exact[1:] - 1.0).mean()
    assert errors["averaged"] < 0.4 * min(errors["consistent"], errors["lumped"])


@pytest.mark.parametrize(("order", "expected"), [(1, 2.0), (2, 4.0), (3, 6.0)])
def test_rates_on_the_flat_torus(order: int, expected: float) -> None:
    errors = []
    for n in (8, 16):
        faces, corners = flat_torus(n)
        nodes = number_nodes(faces, n * n, order)
        elements = assemble_elements(nodes, flat_positions(corners, order))
        exact = torus_values(float(np.sqrt(surface_area(corners))))[:9]
        values = eigenpairs(elements.stiffness, elements.mass, 9, tolerance=1e-11).values
        errors.append(float(np.abs(values[1:] / exact[1:] - 1.0).max()))
    assert rate(errors) > expected - 0.4, errors


@pytest.mark.parametrize("boundary", ["neumann", "dirichlet"])
def test_rates_on_the_rectangle(boundary: str) -> None:
    first = 0 if boundary == "neumann" else 1
    m, n = np.meshgrid(np.arange(first, 12), np.arange(first, 12), indexing="ij")
    exact = np.sort((np.pi**2 * (m**2 / 2.0 + n**2)).ravel())[:8]
    for order in (1, 2):
        errors = []
        for cells in (6, 12):
            mesh = rectangle(cells + 1, cells + 1, float(np.sqrt(2.0)), 1.0).mesh
            elements = surface_elements(mesh, order, boundary=boundary)
            values = eigenpairs(elements.stiffness, elements.mass, 8, tolerance=1e-11).values
            assert np.all(values >= exact - 1e-9)  # Rayleigh-Ritz on an exact domain
            errors.append(float(np.abs(values[1:] / exact[1:] - 1.0).max()))
        assert rate(errors) > 2 * order - 0.3, errors


@pytest.mark.parametrize("boundary", ["neumann", "dirichlet"])
def test_rates_on_the_disk(boundary: str) -> None:
    zeros = jn_zeros if boundary == "dirichlet" else jnp_zeros
    roots = [(zeros(m, 4) ** 2, 1 if m == 0 else 2) for m in range(8)]
    exact = np.sort(np.concatenate([np.repeat(values, times) for values, times in roots]))[:8]
    errors = {}
    for order, rim in ((1, None), (2, onto_circle), (2, None)):
        found = []
        for rings in (5, 10):
            elements = surface_elements(disk(rings).mesh, order, project_boundary=rim, boundary=boundary)
            values = eigenpairs(elements.stiffness, elements.mass, 9, tolerance=1e-11).values
            values = values[1:] if boundary == "neumann" else values[:8]
            found.append(float(np.abs(values / exact - 1.0).max()))
        errors[order, rim is not None] = found
    assert rate(errors[1, False]) > 1.7
    assert rate(errors[2, True]) > 3.0, errors
    assert errors[2, True][-1] < 0.1 * errors[2, False][-1]


def test_weight_scales_and_varies() -> None:
    mesh = rectangle(9, 9, 1.0, 1.0).mesh
    plain = surface_elements(mesh, 2)
    assert abs(surface_elements(mesh, 2, weight=np.full(81, 3.0)).stiffness - 3.0 * plain.stiffness).max() < 1e-11
    by_vertex = surface_elements(mesh, 2, weight=1.0 + mesh.vertices[:, 0])
    by_face = surface_elements(mesh, 2, weight=1.0 + mesh.vertices[mesh.faces, 0].mean(axis=1))
    positions = np.zeros((plain.nodes.count, 3))
    positions[plain.nodes.connectivity] = flat_positions(mesh.vertices[mesh.faces], 2)
    y = positions[:, 1]
    assert y @ (by_vertex.stiffness @ y) == pytest.approx(1.5, rel=1e-12)  # int (1 + x) dx dy
    assert y @ (by_face.stiffness @ y) == pytest.approx(1.5, rel=1e-12)


def test_unfit_requests_are_refused() -> None:
    mesh = icosphere(1).mesh
    with pytest.raises(ValueError, match="choose 1, 2 or 3"):
        surface_elements(mesh, 4)
    with pytest.raises(ValueError, match="mass 'lump' is unknown, choose consistent, lumped or averaged"):
        surface_elements(icosphere(1).mesh, mass="lump")
    with pytest.raises(ValueError, match="no boundary"):
        surface_elements(mesh, boundary="dirichlet")
    with pytest.raises(ValueError, match="order 1"):
        surface_elements(mesh, 2, mass="lumped")
    with pytest.raises(ValueError, match="positive and finite"):
        surface_elements(mesh, weight=np.zeros(80))
    with pytest.raises(ValueError, match="one for each face"):
        surface_elements(mesh, weight=np.ones(5))
    with pytest.raises(ValueError, match="has no area"):
        surface_elements(TriangleMesh(np.zeros((3, 3)), np.array([[0, 1, 2]])))


def torus_values(side: float) -> np.ndarray:
    m = np.arange(-12, 13)
    return np.sort(((2.0 * np.pi / side) ** 2 * (m[:, None] ** 2 + m[None, :] ** 2)).ravel())


def surface_area(corners: np.ndarray) -> float:
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return float(0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
