"""A mesh made anew: of the same surface, and the same in any unit."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.populations.disguise import _bent, _meshed_anew


@pytest.mark.parametrize("scale", [2.0**-10, 2.0**10])
def test_meshing_anew_knows_no_unit(scale: float) -> None:
    mesh = ellipsoid(2, (1.0, 1.3, 0.8)).mesh
    vertices, faces = _meshed_anew(mesh)
    scaled_vertices, scaled_faces = _meshed_anew(TriangleMesh(scale * mesh.vertices, mesh.faces))
    assert np.array_equal(faces, scaled_faces) and np.array_equal(scale * vertices, scaled_vertices)
    anew = TriangleMesh(vertices, faces)
    assert anew.euler_characteristic == 2 and anew.is_closed and len(vertices) <= len(mesh.vertices)
    assert not np.array_equal(np.sort(vertices, axis=0), np.sort(mesh.vertices, axis=0))


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (5.0, -3.0, 2.0)])
def test_bending_keeps_lengths_on_the_middle_plane(place: tuple[float, float, float]) -> None:
    """A box of length 4: rolled into an arc of 2, what lies on its middle plane is as long as before."""
    grid = np.stack(
        np.meshgrid(np.linspace(0, 4, 401), np.linspace(0, 1, 3), np.linspace(0, 0.2, 3), indexing="ij"), -1
    )
    bent = _bent(grid.reshape(-1, 3) + place, 2.0).reshape(grid.shape)
    lengths = np.linalg.norm(np.diff(bent, axis=0), axis=3).sum(axis=0)
    assert lengths[:, 1] == pytest.approx(4.0, rel=1e-4)  # the arc of radius 2 through the middle
    assert sorted({round(float(value), 3) for value in lengths[0]}) == [3.8, 4.0, 4.2]
