"""Embeddings against the closed forms of the sphere, and their invariance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from surfexp.embedding.spectral_embedding import mode_weights, spectral_embedding
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.spectrum.eigensolver import eigenpairs


def system_of(mesh: TriangleMesh, k: int):
    elements = surface_elements(mesh)
    return eigenpairs(elements.stiffness, elements.mass, k)


@pytest.fixture(scope="module")
def sphere():
    mesh = icosphere(4).mesh
    return mesh, system_of(mesh, 122)


def test_first_functions_of_the_sphere_are_a_round_sphere(sphere) -> None:
    mesh, system = sphere
    embedding = spectral_embedding(system, mesh.vertex_areas, 3)
    # sum_m Y_1m^2 = 3 / 4 pi, over lambda = 2, both free of scale
    assert np.linalg.norm(embedding.points, axis=1) == pytest.approx(np.sqrt(3.0 / (8.0 * np.pi)), rel=5e-3)
    assert embedding.values == pytest.approx(2.0 * 4.0 * np.pi, rel=5e-3)
    assert embedding.weights.sum() == pytest.approx(1.0)


def test_squared_norm_grows_like_the_logarithm_and_the_biharmonic_one_converges(sphere) -> None:
    mesh, system = sphere
    degrees = np.arange(1, 11)
    for weighting, terms in (
        ("global_point", (2 * degrees + 1) / (4 * np.pi * degrees * (degrees + 1))),
        ("biharmonic", (2 * degrees + 1) / (16 * np.pi**2 * (degrees * (degrees + 1)) ** 2) * 4 * np.pi / (4 * np.pi)),
    ):
        for degree in (1, 4, 10):
            embedding = spectral_embedding(system, mesh.vertex_areas, (degree + 1) ** 2 - 1, weighting)
            mean = float((embedding.points**2).sum(axis=1) @ embedding.weights)
            expected = terms[:degree].sum()
            # area-normalised: phi^2 / lambda^2 in units of area 1
            assert mean == pytest.approx(expected, rel=0.03), weighting


def test_truncated_greens_function_of_the_sphere(sphere) -> None:
    mesh, system = sphere
    embedding = spectral_embedding(system, mesh.vertex_areas, 120)
    cosine = mesh.vertices @ mesh.vertices[0]
    kernel = embedding.points @ embedding.points[0]
    away = cosine < 0.5
    exact = -np.log(1.0 - cosine[away]) / (4.0 * np.pi)
    difference = kernel[away] - exact
    # -(1 / 4 pi) ln(1 - cos) + const, with const = (ln 2 - 1) / 4 pi
    assert difference.mean() == pytest.approx((np.log(2.0) - 1.0) / (4.0 * np.pi), abs=1e-3)
    assert difference.std() < 3e-3
    assert kernel[0] > 0.35 and kernel[0] < 0.5


@pytest.mark.parametrize("weighting", ["global_point", "biharmonic", "heat_kernel", "diffusion"])
def test_scale_leaves_every_embedding_as_it_is(weighting: str) -> None:
    mesh = icosphere(2).mesh
    stretched = TriangleMesh(mesh.vertices * [1.0, 1.3, 0.8], mesh.faces)
    large = TriangleMesh(stretched.vertices * 70.0, mesh.faces)
    first, second = (spectral_embedding(system_of(m, 7), m.vertex_areas, 6, weighting) for m in (stretched, large))
    assert np.abs(first.points) == pytest.approx(np.abs(second.points), abs=1e-7)
    assert first.values == pytest.approx(second.values, rel=1e-9)


def test_samples_share_the_area_and_repeat(sphere) -> None:
    mesh, system = sphere
    embedding = spectral_embedding(system, mesh.vertex_areas, 3)
    sample = embedding.sample(500, 3)
    assert len(sample.points) == 500 and sample.weights.sum() == pytest.approx(1.0)
    assert np.array_equal(sample.points, embedding.sample(500, 3).points)
    assert not np.array_equal(sample.points, embedding.sample(500, 4).points)
    assert sample.points.mean(axis=0) == pytest.approx(0.0, abs=0.03)
    assert embedding.sample(10**6) is embedding


def test_what_no_embedding_can_be_made_of_is_refused(sphere) -> None:
    mesh, system = sphere
    with pytest.raises(ValueError, match="n = 200 eigenfunctions after the constant need 201"):
        spectral_embedding(system, mesh.vertex_areas, 200)
    with pytest.raises(ValueError, match="the surface has 5 vertices"):
        spectral_embedding(system, np.ones(5), 3)
    two = icosphere(1).mesh
    pair = TriangleMesh(np.vstack([two.vertices, two.vertices + 5.0]), np.vstack([two.faces, two.faces + 42]))
    with pytest.raises(ValueError, match="2 eigenvalues are zero"):
        spectral_embedding(system_of(pair, 6), pair.vertex_areas, 3)
    with pytest.raises(ValueError, match="not finite"):
        spectral_embedding(replace(system, vectors=system.vectors * np.nan), mesh.vertex_areas, 3)
    with pytest.raises(ValueError, match="unknown, choose one of global_point"):
        mode_weights(np.ones(3), "gps")
    with pytest.raises(ValueError, match="take a positive one"):
        mode_weights(np.ones(3), "diffusion", 0.0)
