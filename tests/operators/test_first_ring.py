"""The definitions (1.17), (1.18) are the matrix products (1.27)."""

import numpy as np
import pytest

from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.operators.first_ring import ring_divergence, ring_gradient
from surfexp.operators.vertex_averaged import vertex_averaged


@pytest.mark.parametrize("surface", [torus(24, 12, jitter=0.2), disk(6)])
def test_definitions_equal_the_products(surface: Surface) -> None:
    mesh, random = surface.mesh, np.random.default_rng(0)
    matrices = vertex_averaged(mesh).averaged_gradient
    assert matrices is not None
    values, field = random.normal(size=len(mesh.vertices)), random.normal(size=mesh.vertices.shape)
    slopes = np.stack([w @ values for w in matrices], axis=1)
    assert np.abs(ring_gradient(mesh.vertices, mesh.faces, values) - slopes).max() <= 1e-11 * np.abs(slopes).max()
    sources = sum(w @ field[:, x] for x, w in enumerate(matrices))
    assert np.abs(ring_divergence(mesh.vertices, mesh.faces, field) - sources).max() <= 1e-11 * np.abs(sources).max()
