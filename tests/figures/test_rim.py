"""The rim of a surface as a level set, and nodal lines that end at it."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.figures.boundary_line import INSIDE, barycentric, without_rim
from surfexp.figures.level_set import level_set
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle


def test_finer_mesh_is_the_same_surface() -> None:
    mesh = icosphere(1).mesh
    field = mesh.vertices @ [1.0, 2.0, 3.0]
    finer, rim, (same,) = barycentric(mesh, field)
    assert len(finer.faces) == 6 * len(mesh.faces)
    assert finer.is_closed and finer.area == pytest.approx(mesh.area)
    assert np.allclose(same, finer.vertices @ [1.0, 2.0, 3.0])
    assert np.allclose(np.cross(finer.face_normals[: len(mesh.faces)], mesh.face_normals), 0.0)
    assert (finer.face_normals[: len(mesh.faces)] * mesh.face_normals).sum(axis=1) == pytest.approx(1.0)
    assert not rim.any()


@pytest.mark.parametrize("mesh", [rectangle(9, 7).mesh, disk(5).mesh], ids=["rectangle", "disk"])
def test_line_runs_along_the_whole_rim_and_nowhere_else(mesh) -> None:  # type: ignore[no-untyped-def]
    finer, rim, _ = barycentric(mesh)
    line = level_set(finer, rim, 1.0 - INSIDE)
    assert len(line.lines) == 1
    perimeter = np.linalg.norm(np.diff(mesh.vertices[mesh.edges[mesh.edge_face_counts == 1]], axis=1), axis=2).sum()
    assert line.length == pytest.approx(perimeter, rel=0.1)
    ends = mesh.vertices[np.unique(mesh.edges[mesh.edge_face_counts == 1])]
    away = np.linalg.norm(line.points[:, None] - ends, axis=2).min(axis=1)
    assert away.max() <= mesh.edge_length


def test_nodal_lines_reach_a_fixed_rim_straight() -> None:
    mesh = rectangle(21, 15, width=np.pi, height=1.0).mesh
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    values = np.sin(2.0 * x) * np.sin(np.pi * y)
    values[np.unique(mesh.edges[mesh.edge_face_counts == 1])] = 0.0
    moved = without_rim(mesh, values)
    inside = values != 0.0
    assert (moved[inside] == values[inside]).all()
    line = level_set(mesh, moved, 0.0)
    assert len(line.lines) == 1
    assert np.abs(line.points[:, 0] - 0.5 * np.pi).max() < 0.06
    assert np.ptp(line.points[:, 1]) == pytest.approx(1.0)
