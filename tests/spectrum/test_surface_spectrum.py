"""Spectra of surfaces: exact values, invariances, Weyl's law, and what (3.25) says of bounds."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.exact_spectra import disk_spectrum, lattice_spectrum, rectangle_spectrum, sphere_spectrum
from surfexp.mesh.flat_shapes import Rectangle
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.nodal_signature import counted_domains, courant_report, trusted_modes, zero_modes
from surfexp.spectrum.spectral_signature import spectral_signature, spectrum_part
from surfexp.spectrum.surface_spectrum import elements_of, graph_of, surface_spectrum


def spectrum(surface: Surface, count: int = 25, **options):
    return surface_spectrum(surface, fem(surface.mesh), count, **options)


def test_a_multiple_eigenvalue_at_the_shift_costs_no_accuracy() -> None:
    # 0.6 lambda_20 is 12, seven times an eigenvalue of the sphere; k = 20 cuts the nine of 20
    system = spectrum(icosphere(3), 20, order=2, curved=True)
    assert system.complete and system.metrics["largest_residual"] < 1e-9
    assert any("k = 25" in note for note in system.notes)
    assert system.values == pytest.approx(sphere_spectrum(20), rel=2e-4, abs=1e-9)


@pytest.mark.parametrize(
    ("surface", "boundary", "bound"),
    [
        (icosphere(3), "neumann", 2e-4),
        (disk(14), "dirichlet", 1e-3),
        (disk(14), "neumann", 1e-3),
        (rectangle(25, 17, 1.5, 1.0), "neumann", 2e-3),
        (rectangle(25, 17, 1.5, 1.0), "dirichlet", 2e-3),
    ],
)
def test_exact_spectra(surface: Surface, boundary: str, bound: float) -> None:
    curved = not isinstance(surface.shape, Rectangle)
    system = spectrum(surface, order=2, curved=curved, boundary=boundary)
    exact = surface.shape.spectrum(25, boundary)
    assert np.abs(system.values - exact).max() < bound * exact[-1]
    assert system.complete and zero_modes(system) == (boundary == "neumann")


def test_closed_forms() -> None:
    assert sphere_spectrum(5, 2.0) == pytest.approx([0, 0.5, 0.5, 0.5, 1.5])
    assert rectangle_spectrum(3, 2.0, 1.0, "neumann") == pytest.approx(np.pi**2 * np.array([0, 0.25, 1.0]))
    assert disk_spectrum(3, 1.0, "dirichlet") == pytest.approx([5.783186, 14.681971, 14.681971])
    assert disk_spectrum(3, 1.0, "neumann") == pytest.approx([0, 3.389958, 3.389958])
    assert lattice_spectrum(5, np.eye(2)) == pytest.approx(4 * np.pi**2 * np.array([0, 1, 1, 1, 1]))
    assert lattice_spectrum(8, np.array([[1.0, 0.0], [-0.5, 0.75**0.5]])) == pytest.approx(
        4 * np.pi**2 * np.array([0, *[4 / 3] * 6, 4.0])
    )


def test_nodes_of_a_curved_torus_lie_on_it() -> None:
    points = torus(24, 12, 1.0, 0.3).shape.project(
        np.random.default_rng(0).normal(size=(50, 3)) * 0.1 + [1.2, 0.1, 0.1]
    )
    assert np.hypot(np.linalg.norm(points[:, :2], axis=1) - 1.0, points[:, 2]) == pytest.approx(0.3)
    with pytest.raises(ValueError, match="choose curved=false"):
        spectrum(rectangle(), order=2, curved=True)


def test_values_are_no_lower_bounds_on_facets() -> None:
    # (3.25) holds on the polyhedron, not against the smooth sphere: outside of it values fall below the exact ones
    mesh = icosphere(4).mesh
    distance = np.abs((mesh.vertices[mesh.faces[:, 0]] * mesh.face_normals).sum(axis=1)).min()
    outside = Surface(TriangleMesh(mesh.vertices / distance, mesh.faces), "sphere")
    value = spectrum(outside, 4).values[1]
    assert value == pytest.approx(1.9983, abs=2e-4) and value < 2.0


def test_scale_rotation_and_numbering_do_not_matter() -> None:
    ball = icosphere(3).mesh
    mesh = TriangleMesh(ball.vertices * [1.3, 1.0, 0.7], ball.faces)
    rng = np.random.default_rng(0)
    turn, order = np.linalg.qr(rng.normal(size=(3, 3)))[0], rng.permutation(len(mesh.vertices))
    turn *= np.sign(np.linalg.det(turn))
    moved = TriangleMesh(2.5 * mesh.vertices[order] @ turn.T + 4.0, np.argsort(order)[mesh.faces])
    one, two = (spectral_signature(Surface(m), fem(m), 40) for m in (mesh, moved))
    assert two.values == pytest.approx(one.values, rel=1e-7)
    assert two.part("shape_dna_raw") * 6.25 == pytest.approx(one.part("shape_dna_raw"), rel=1e-7)
    assert np.array_equal(one.part("nodal_counts"), two.part("nodal_counts"))
    for part in ("nodal_soft", "combined", "heat_trace", "hks", "wks"):
        assert two.part(part) == pytest.approx(one.part(part), rel=1e-5, abs=1e-5), part
    assert two.part("area") == pytest.approx(6.25 * one.part("area"))
    with pytest.raises(ValueError, match="choose one of area"):
        one.part("volume")


def test_weyls_law() -> None:
    surface = torus(60, 24)
    system = spectrum(surface, 200, order=2)
    numbers = np.arange(100, 200)
    assert (system.values[100:] * system.area / (4 * np.pi * numbers)).mean() == pytest.approx(1.0, abs=0.05)


def test_several_components_are_counted_and_said() -> None:
    ball = icosphere(2).mesh
    mesh = TriangleMesh(
        np.concatenate([ball.vertices, ball.vertices + 5.0]), np.concatenate([ball.faces, ball.faces + 162])
    )
    system = spectrum(Surface(mesh), 12)
    assert system.metrics["zero_modes"] == 2.0 and zero_modes(system) == 2
    assert any("2 components" in note for note in system.notes)
    with pytest.raises(ValueError, match="no boundary for dirichlet"):
        spectrum(icosphere(2), 5, boundary="dirichlet")


def test_intrinsic_triangles_of_slivers() -> None:
    mesh = torus(60, 12, 1.0, 0.2, jitter=0.24).mesh
    surface = Surface(mesh, "torus")
    operator = intrinsic_delaunay(mesh)
    assert not np.array_equal(operator.faces, mesh.faces)
    system = surface_spectrum(surface, operator, 12)
    assert system.values == pytest.approx(spectrum(surface, 12).values, rel=0.02, abs=1e-9)
    with pytest.raises(ValueError, match="choose fem, or order 1"):
        elements_of(surface, operator, 2)


def test_counts_on_quadratic_elements_agree_with_linear_ones_at_low_modes() -> None:
    ball = icosphere(4).mesh
    surface = Surface(TriangleMesh(ball.vertices * [1.5, 1.0, 0.7], ball.faces))
    operator = fem(surface.mesh)
    counts = []
    for order in (1, 2):
        system = surface_spectrum(surface, operator, 40, order=order)
        counts.append(counted_domains(system, graph_of(operator, system)))
        assert courant_report(system, counts[-1])[0]["courant_violations"] == 0
    assert np.mean(counts[0][:20] == counts[1][:20]) >= 0.9
    assert trusted_modes(2500) == 25
    with pytest.raises(ValueError, match="choose one of raw"):
        counted_domains(system, graph_of(operator, system), "best")  # type: ignore[arg-type]


def test_inertia_equals_dense_counts_at_random_shifts_on_a_clustered_spectrum() -> None:
    from scipy.linalg import eigh

    from surfexp.spectrum.shifted_pencil import ShiftedPencil

    surface = torus(25, 20)
    elements = elements_of(surface, fem(surface.mesh))
    exact = eigh(elements.stiffness.toarray(), elements.mass.toarray(), eigvals_only=True)
    pencil = ShiftedPencil(elements.stiffness, elements.mass)
    rng = np.random.default_rng(0)
    for shift in rng.uniform(exact[1] / 2, exact[300], 25):
        used, _ = pencil.factor(float(shift), 1e-8)
        assert pencil.counts[used] == (exact < used).sum()
    assert len(eigenpairs(elements.stiffness, elements.mass, 60).clusters) > 10


def test_only_averaged_counts_are_no_whole_numbers() -> None:
    """The five modes of degree 2 of a sphere are one cluster, whose members have 3 or 4 domains by their basis."""
    sphere = icosphere(3)
    system = spectrum(sphere, 9)
    graph = graph_of(fem(sphere.mesh), system)
    for counting in ("raw", "filtered"):
        counts = counted_domains(system, graph, counting)
        assert (counts == np.round(counts)).all() and (counts[:4] == [1, 2, 2, 2]).all()
    averaged = counted_domains(system, graph, "averaged")[4:]
    assert (averaged != np.round(averaged)).any() and 3 <= averaged.min() <= averaged.max() <= 4


def test_of_counts_the_constant_modes_of_each_component_are_left_out() -> None:
    one = icosphere(2).mesh
    two = TriangleMesh(np.concatenate([one.vertices, one.vertices + 9.0]), np.concatenate([one.faces, one.faces + 162]))
    for mesh, constant in ((one, 1), (two, 2)):
        system = spectrum(Surface(mesh), 8)
        assert spectrum_part(system, np.arange(8.0)).tolist() == list(range(constant, 8))
