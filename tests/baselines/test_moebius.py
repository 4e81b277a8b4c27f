"""Moebius transformations of the sphere: angles stay, centres of mass move to the origin."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.baselines.distortion import distortion
from surfexp.baselines.moebius import centred, invert
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

MESH = icosphere(3).mesh
coordinates = st.floats(-0.5, 0.5)


@settings(max_examples=30, deadline=None)
@given(st.tuples(coordinates, coordinates, coordinates))
def test_the_sphere_stays_and_cross_ratios_stay(centre):
    """|x - y| |z - w| / (|x - z| |y - w|) is what Moebius transformations keep."""
    points = MESH.vertices[::40]
    moved = invert(points, np.array(centre))
    np.testing.assert_allclose(np.linalg.norm(moved, axis=1), 1, atol=1e-12)

    def cross_ratios(p):
        x, y, z, w = p[:-3], p[1:-2], p[2:-1], p[3:]
        norms = [np.linalg.norm(d, axis=1) for d in (x - y, z - w, x - z, y - w)]
        return norms[0] * norms[1] / (norms[2] * norms[3])

    np.testing.assert_allclose(cross_ratios(moved), cross_ratios(points), rtol=1e-9)
    image = TriangleMesh(invert(MESH.vertices, np.array(centre)), MESH.faces)
    assert distortion(MESH, image, np.zeros(3))["flipped_faces"] == 0


def test_centring_undoes_a_moebius_transformation():
    areas = MESH.vertex_areas
    for size in (0.3, 0.9, 0.99):
        moved = invert(MESH.vertices, size * np.array([0.6, 0.0, 0.8]))
        assert np.linalg.norm(areas @ moved / areas.sum()) > 0.2
        back = centred(moved, areas, iteration_limit=12)
        assert np.linalg.norm(areas @ back / areas.sum()) < 1e-9
        left, _, right = np.linalg.svd(back.T @ MESH.vertices)
        np.testing.assert_allclose(back @ (left @ right), MESH.vertices, atol=1e-8)


def test_what_cannot_be_centred_is_refused():
    with pytest.raises(ValueError, match="less than 1"):
        invert(MESH.vertices, np.array([0.0, 0.0, 1.0]))
    heavy = np.ones(len(MESH.vertices))
    heavy[0] = 2 * len(heavy)
    with pytest.raises(ValueError, match="crowds the surface into a point"):
        centred(MESH.vertices, heavy)
