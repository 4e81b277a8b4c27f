"""A mesh made anew: of the same surface, and the same in any unit."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.studies.populations.disguise import _meshed_anew


@pytest.mark.parametrize("scale", [2.0**-10, 2.0**10])
def test_meshing_anew_knows_no_unit(scale: float) -> None:
    mesh = ellipsoid(2, (1.0, 1.3, 0.8)).mesh
    vertices, faces = _meshed_anew(mesh)
    scaled_vertices, scaled_faces = _meshed_anew(TriangleMesh(scale * mesh.vertices, mesh.faces))
    assert np.array_equal(faces, scaled_faces) and np.array_equal(scale * vertices, scaled_vertices)
    anew = TriangleMesh(vertices, faces)
    assert anew.euler_characteristic == 2 and anew.is_closed and len(vertices) <= len(mesh.vertices)
    assert not np.array_equal(np.sort(vertices, axis=0), np.sort(mesh.vertices, axis=0))
