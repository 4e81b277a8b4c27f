"""Surfaces from points; runs where open3d is installed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from surfexp.io.point_cloud import read_points, reconstruct
from surfexp.io.reading import read_mesh
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.validate import validate

POINTS = icosphere(4).mesh.vertices


def test_too_few_points_are_refused_before_open3d_is_asked_for() -> None:
    with pytest.raises(ValueError, match="20 points; more than neighbours = 30"):
        reconstruct(POINTS[:20])


@pytest.mark.optional
def test_sphere_comes_back_from_its_points() -> None:
    pytest.importorskip("open3d", exc_type=ImportError)
    mesh = reconstruct(POINTS, depth=6).mesh
    assert validate(mesh.vertices, mesh.faces).ok
    assert mesh.genus == 0 and mesh.is_closed and mesh.component_count == 1
    assert np.linalg.norm(mesh.vertices, axis=1) == pytest.approx(1.0, abs=0.005)
    assert (reconstruct(POINTS, depth=6).mesh.vertices == mesh.vertices).all()


@pytest.mark.optional
def test_open3d_reads_what_it_wrote(tmp_path: Path) -> None:
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    sphere = open3d.geometry.TriangleMesh.create_sphere()
    open3d.io.write_triangle_mesh(str(tmp_path / "a.gltf"), sphere)
    vertices, faces, _ = read_mesh(tmp_path / "a.gltf")
    assert len(faces) == len(sphere.triangles)
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(1.0, abs=1e-6)
    open3d.io.write_point_cloud(str(tmp_path / "a.pcd"), open3d.geometry.PointCloud(sphere.vertices))
    assert len(read_points(tmp_path / "a.pcd")) == len(sphere.vertices)
    (tmp_path / "b.pcd").write_text("garbage")
    with pytest.raises(ValueError, match=r"b\.pcd cannot be read as a point cloud"):
        read_points(tmp_path / "b.pcd")
