"""Formats of single precision take what it can hold and refuse the rest; nothing becomes inf, zero or one point quietly."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from surfexp.io.map_files import read_scalars
from surfexp.io.reading import read_mesh
from surfexp.io.writing import write_mesh
from surfexp.io.written_maps import write_maps
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh

BALL = icosphere(1).mesh
SURFACES = ["ball.surf.gii", "ball.stl", "lh.white"]
MAPS = ["ball.shape.gii", "lh.thickness", "ball.mgh", "ball.dscalar.nii"]


def moved(scale: float = 1.0, offset: float = 0.0) -> TriangleMesh:
    return TriangleMesh(scale * BALL.vertices + offset, BALL.faces)


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize(
    ("mesh", "said"),
    [
        (moved(1e50), "the largest value of the vertices is 1e+50"),
        (moved(1e-50), "the largest value of the vertices is 1e-50"),
        (moved(1e-3, 1e6), "edges have no length"),
    ],
    ids=["large", "small", "far away"],
)
def test_a_surface_that_single_precision_would_change_is_refused(
    tmp_path: Path, name: str, mesh: TriangleMesh, said: str
) -> None:
    with pytest.raises(ValueError, match="single precision") as refusal:
        write_mesh(tmp_path / name, mesh)
    assert said in str(refusal.value)
    assert not (tmp_path / name).exists()


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("mesh", [moved(1e30), moved(1e-30), moved(1.0, 1e4)], ids=["large", "small", "far away"])
def test_a_surface_within_single_precision_comes_back(tmp_path: Path, name: str, mesh: TriangleMesh) -> None:
    write_mesh(tmp_path / name, mesh)
    vertices, faces, _ = read_mesh(tmp_path / name)
    assert len(vertices) == len(mesh.vertices)
    error = np.abs(vertices[faces] - mesh.vertices[mesh.faces]).max()
    assert error <= 2.0**-24 * np.abs(mesh.vertices).max()


@pytest.mark.parametrize("name", MAPS)
@pytest.mark.parametrize("value", [1e50, -1e50, np.inf])
def test_a_map_beyond_single_precision_is_refused(tmp_path: Path, name: str, value: float) -> None:
    values = np.linspace(0.0, 1.0, 42)
    values[7] = value
    with pytest.raises(ValueError, match="map"):
        write_maps(tmp_path / name, {"height": values}, "left")
    assert not (tmp_path / name).exists()


@pytest.mark.parametrize("name", MAPS)
def test_a_map_keeps_its_digits(tmp_path: Path, name: str) -> None:
    values = np.linspace(-3e30, 3e30, 42)
    write_maps(tmp_path / name, {"height": values}, "left")
    found = read_scalars(tmp_path / name, "left")
    assert np.abs(np.ravel(found) - values).max() <= 2.0**-24 * 3e30
