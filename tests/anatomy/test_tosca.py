"""Shapes of TOSCA from a user's copy: text tables, the original .mat, and defects that are mended with a report."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from surfexp.io.tosca import read_mat
from surfexp.lab.registry import registry
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface

PLUGIN = Path(__file__).resolve().parents[2] / "plugins" / "surface" / "tosca.py"


def read(path: Path) -> Surface:
    registry.load_file(PLUGIN)
    method = registry.plugin("surface", "tosca")
    return method({"path": path})


def test_mat_and_text_agree(tmp_path: Path) -> None:
    from scipy.io import savemat

    mesh = icosphere(2).mesh
    x, y, z = mesh.vertices.T
    savemat(tmp_path / "cat0.mat", {"surface": {"X": x, "Y": y, "Z": z, "TRIV": mesh.faces + 1}})
    np.savetxt(tmp_path / "cat0.vert", mesh.vertices, fmt="%.17g")
    np.savetxt(tmp_path / "cat0.tri", mesh.faces + 1, fmt="%d")
    one, two = read(tmp_path / "cat0.mat"), read(tmp_path / "cat0.vert")
    assert one.name == "cat0" and one.metrics["changes"] == 0.0
    assert np.array_equal(one.mesh.vertices, two.mesh.vertices) and np.array_equal(one.mesh.faces, two.mesh.faces)
    points, faces = read_mat(tmp_path / "cat0.mat")
    assert np.array_equal(points, mesh.vertices) and np.array_equal(faces, mesh.faces)
    savemat(tmp_path / "dog0.mat", {"shape": 1.0})
    with pytest.raises(ValueError, match=r"dog0\.mat has no variable 'surface'"):
        read(tmp_path / "dog0.mat")


def test_defects_are_mended_and_said(tmp_path: Path) -> None:
    mesh = icosphere(2).mesh
    faces = mesh.faces.copy()
    faces[:40] = faces[:40, ::-1]
    np.savetxt(tmp_path / "wolf0.vert", mesh.vertices, fmt="%.17g")
    np.savetxt(tmp_path / "wolf0.tri", np.vstack([faces, faces[:1]]) + 1, fmt="%d")
    surface = read(tmp_path / "wolf0.vert")
    assert surface.mesh.is_closed and surface.mesh.genus == 0
    assert surface.metrics["changes"] >= 2 and len(surface.notes) >= 2
