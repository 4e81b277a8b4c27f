"""Noise estimated from a map: exact on affine functions, right within a tenth on planted noise of many sizes."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.models.deblurring import Deblurring
from surfexp.variational.models.rof import ROF
from surfexp.variational.noise_level import affine_relations, noise_level
from surfexp.variational.solvers.primal_dual import primal_dual


def jittered_rectangle() -> TriangleMesh:
    mesh = rectangle(40, 30).mesh
    inner = np.ones(len(mesh.vertices), bool)
    inner[np.concatenate(mesh.boundary_loops)] = False
    move = np.random.default_rng(0).uniform(-0.008, 0.008, mesh.vertices.shape) * inner[:, None] * [1, 1, 0]
    return TriangleMesh(mesh.vertices + move, mesh.faces)


def test_affine_functions_have_no_noise() -> None:
    mesh = jittered_rectangle()
    corners, relations = affine_relations(fem(mesh))
    assert len(corners) == (mesh.edge_face_counts == 2).sum()
    assert np.abs(relations.sum(axis=1)).max() < 1e-12
    assert np.linalg.norm(relations, axis=1) == pytest.approx(1.0)
    for affine in (mesh.vertices[:, 0], 3.0 - 2.0 * mesh.vertices[:, 1]):
        assert np.abs((relations * affine[corners]).sum(axis=1)).max() < 1e-12


@pytest.mark.parametrize("sigma", [0.05, 0.2, 1.0, 5.0])
@pytest.mark.parametrize("surface", [icosphere(4), icosphere(5), torus(), rectangle(60, 60)], ids=lambda s: s.name)
def test_planted_noise_is_found_within_a_tenth(surface, sigma: float) -> None:
    mesh = surface.mesh
    rng = np.random.default_rng(1)
    size = np.ptp(mesh.vertices[:, 0])
    image = np.sign(mesh.vertices[:, 0] - mesh.vertices[:, 0].mean()) + np.sin(3.0 * mesh.vertices[:, 1] / size)
    found = noise_level(fem(mesh), image + sigma * rng.standard_normal(len(image)))
    assert found == pytest.approx(sigma, rel=0.1)


def test_units_and_offsets_do_not_matter() -> None:
    mesh = icosphere(3).mesh
    image = np.random.default_rng(0).standard_normal(len(mesh.vertices))
    once = noise_level(fem(mesh), image)
    large = TriangleMesh(1e3 * mesh.vertices, mesh.faces)
    assert noise_level(fem(large), 7.0 + 1e-3 * image) == pytest.approx(1e-3 * once, rel=1e-9)


def test_too_few_triangles_are_refused() -> None:
    mesh = TriangleMesh(np.eye(3), np.array([[0, 1, 2]]))
    with pytest.raises(ValueError, match="0 pairs of triangles"):
        noise_level(fem(mesh), np.arange(3.0))


def test_rof_estimates_the_noise_of_a_map_that_came_as_it_is() -> None:
    surface = icosphere(4).mesh
    operator = fem(surface)
    rng = np.random.default_rng(3)
    noisy = np.where(surface.vertices[:, 2] > 0, 5.0, 1.0) + 0.4 * rng.normal(size=len(surface.vertices))
    as_it_is = ROF().run(Image(noisy, "map", "mm"), operator, primal_dual)
    known = ROF().run(Image(noisy, "map", "mm", noise=noise_level(operator, noisy)), operator, primal_dual)
    assert (as_it_is.values == known.values).all() and as_it_is.converged
    assert "estimated as 0.4" in as_it_is.notes[-1] and " mm." in as_it_is.notes[-1]
    assert not any("estimated" in note for note in known.notes)
    sharpened = Deblurring(width=1.0).run(Image(noisy, "map"), operator, primal_dual)
    assert "estimated as 0.4" in sharpened.notes[-1] and sharpened.converged
    assert ROF(mu=1.0).run(Image(noisy, "map"), operator, primal_dual).notes == known.notes
    with pytest.raises(ValueError, match="needs sigma > 0"):
        ROF().run(Image(noisy, "clean", clean=noisy), operator, primal_dual)


def test_channels_are_pooled() -> None:
    operator = fem(icosphere(4).mesh)
    noise = np.random.default_rng(0).normal(size=(len(operator.mass), 3))
    assert noise_level(operator, 0.3 * noise) == pytest.approx(0.3, rel=0.05)
    pooled = noise_level(operator, noise * [0.1, 0.1, 5.0])
    assert noise_level(operator, 0.1 * noise[:, 0]) < pooled < noise_level(operator, 5.0 * noise[:, 2])
