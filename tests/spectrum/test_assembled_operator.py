"""Matrices summed in one pass over the faces are those of the general elements of order 1."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.operators.intrinsic_delaunay import intrinsic_delaunay
from surfexp.spectrum.lowest_pairs import assembled
from surfexp.spectrum.surface_spectrum import elements_of


@pytest.mark.parametrize("make", [fem, intrinsic_delaunay])
@pytest.mark.parametrize("mass", ["consistent", "lumped", "averaged"])
@pytest.mark.parametrize("boundary", ["neumann", "dirichlet"])
def test_both_assemblies_agree(make, mass: str, boundary: Literal["neumann", "dirichlet"]) -> None:  # type: ignore[no-untyped-def]
    ball = icosphere(3).mesh
    cap = ball.faces[(ball.vertices[ball.faces][:, :, 2] > -0.4).all(axis=1)]
    kept, faces = np.unique(cap, return_inverse=True)
    drawn = 0.02 * np.random.default_rng(0).standard_normal((len(kept), 3))
    mesh = TriangleMesh(ball.vertices[kept] + drawn, faces.reshape(-1, 3))
    operator = make(mesh)
    general, quick = (
        elements_of(Surface(mesh), one, mass=mass, boundary=boundary)  # type: ignore[arg-type]
        for one in (operator, assembled(operator))
    )
    for name in ("stiffness", "mass"):
        one, other = getattr(general, name), getattr(quick, name)
        assert abs(one - other).max() <= 1e-14 * abs(one).max()
        assert abs(other - other.T).max() == 0.0
    assert general.nodes.count == quick.nodes.count == len(mesh.vertices)
    assert np.array_equal(general.free, quick.free) and quick.area == pytest.approx(general.area, rel=1e-14)
