"""Signatures: scale invariance, limits, and invariance under symmetry of the surface."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.operators.fem import fem
from surfexp.spectrum.brainprint import brainprint
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.pointwise_signatures import global_point_signature, wave_kernel_signature
from surfexp.spectrum.shape_dna import shape_dna
from surfexp.spectrum.spectral_signature import spectral_signature
from surfexp.spectrum.surface_spectrum import surface_spectrum


def ellipsoid_system(scale: float, k: int = 60):
    ball = icosphere(3).mesh
    mesh = TriangleMesh(scale * ball.vertices * [1.3, 1.0, 0.7], ball.faces)
    elements = surface_elements(mesh)
    return eigenpairs(elements.stiffness, elements.mass, k), elements.area


@pytest.mark.parametrize("normalisation", ["area", "volume", "first", "slope"])
def test_normalised_shape_dna_does_not_know_the_size(normalisation: str) -> None:
    signatures = []
    for scale in (1.0, 7.3):
        system, area = ellipsoid_system(scale)
        signatures.append(shape_dna(system.values, normalisation, area, volume=scale**3))
    assert len(signatures[0]) == 59
    assert np.allclose(signatures[0], signatures[1], rtol=1e-9)
    raw = [shape_dna(ellipsoid_system(scale)[0].values, "raw") for scale in (1.0, 7.3)]
    assert np.allclose(raw[0], 7.3**2 * raw[1], rtol=1e-9)


def test_weyl_limit_of_slope_and_area() -> None:
    sphere = np.array([degree * (degree + 1.0) for degree in range(40) for _ in range(2 * degree + 1)])
    assert shape_dna(sphere, "slope")[-1] == pytest.approx(len(sphere) - 1, rel=0.05)
    assert shape_dna(sphere, "area", 4.0 * np.pi, reweighted=True)[-1] == pytest.approx(4.0 * np.pi, rel=0.05)


def test_point_signatures_keep_the_symmetry_of_the_ellipsoid() -> None:
    system, _ = ellipsoid_system(1.0)
    vertices = icosphere(3).mesh.vertices
    mirror = np.array([np.linalg.norm(vertices - v * [1.0, 1.0, -1.0], axis=1).argmin() for v in vertices])
    waves = wave_kernel_signature(system, 20)
    assert np.allclose(waves, waves[mirror], atol=1e-7)
    assert waves.std(axis=0).min() > 0.0
    points = global_point_signature(system, 1.0)
    assert np.allclose(np.abs(points), np.abs(points[mirror]), atol=1e-6)


def test_a_band_of_the_wave_kernel_is_a_gaussian_of_the_stated_width() -> None:
    """With two modes and eight bands a width of seven bands is the distance of their energies."""
    two = EigenSystem(np.array([2.0, 5.0]), np.eye(2), np.zeros(2), 0.0, True)
    near, far = wave_kernel_signature(two, 8, 7.0)[:, 0]
    assert far / near == pytest.approx(np.exp(-0.5), rel=1e-12) and near + far == pytest.approx(1.0, rel=1e-12)


def test_published_point_signature_diverges_and_the_biharmonic_one_does_not() -> None:
    system, _ = ellipsoid_system(1.0, 150)
    for power, growth in ((0.5, (0.05, 1.0)), (1.0, (0.0, 0.02))):
        norms = (global_point_signature(system, power) ** 2).cumsum(axis=1).mean(axis=0)
        assert growth[0] <= norms[-1] / norms[70] - 1.0 <= growth[1]


def test_a_signature_has_each_kind_of_count_for_each_mode() -> None:
    ball = icosphere(2)
    stretched = Surface(TriangleMesh(ball.mesh.vertices * [1.3, 1.0, 0.7], ball.mesh.faces), "stretched")
    parts = spectral_signature(stretched, fem(stretched.mesh), 12).parts
    kinds = [parts[name] for name in ("nodal_raw", "nodal_soft", "nodal_counts", "shape_dna_raw")]
    assert [len(kind) for kind in kinds] == [12, 12, 12, 12]
    assert kinds[0][0] == kinds[2][0] == 2


def test_a_missing_size_is_named() -> None:
    with pytest.raises(ValueError, match="needs a positive area"):
        shape_dna(np.arange(5.0), "area")
    with pytest.raises(ValueError, match="choose one of raw"):
        shape_dna(np.arange(5.0), "mass")


@pytest.mark.optional
def test_brainprint_of_lapy_is_our_reweighted_shape_dna(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = torus(30, 12)
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "lapy", None)
        with pytest.raises(ImportError, match="brainprint needs lapy"):
            brainprint(surface.mesh, 10)
    with pytest.raises(ValueError, match="take at most 358"):
        brainprint(surface.mesh, 500)
    pytest.importorskip("lapy")
    system = surface_spectrum(surface, fem(surface.mesh), 21)
    ours = shape_dna(system.values, "area", system.area, reweighted=True)
    assert brainprint(surface.mesh, 20).values == pytest.approx(ours, rel=1e-5)
