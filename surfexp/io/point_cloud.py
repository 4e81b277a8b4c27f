"""Surfaces from point clouds, reconstructed by open3d."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.io.npz import read_arrays
from surfexp.io.numbers import real_array
from surfexp.io.open3d_files import import_open3d
from surfexp.mesh.repair import Repaired, repair


def read_points(path: Path | str) -> Floats:
    """(n, 3) points of a .xyz text table (further columns are left out), a .npy array, or what open3d reads (.pcd, .ply).

    Raises
    ------
    ValueError
        If the file holds no points; the message begins with the file's name.
    """
    path = Path(path)
    try:
        if path.suffix == ".npy":
            points = real_array(read_arrays(path)["map"], "the points")
        elif path.suffix in (".xyz", ".xyzn", ".xyzrgb", ".txt"):
            points = np.loadtxt(path, ndmin=2)
        else:
            open3d = import_open3d()
            with open3d.utility.VerbosityContextManager(open3d.utility.VerbosityLevel.Error):
                points = np.asarray(open3d.io.read_point_cloud(str(path)).points)
        points = np.asarray(points, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] < 3 or not len(points) or not np.isfinite(points).all():
            raise ValueError(f"array of shape {points.shape} is no list of finite points")
    except (ValueError, OSError, EOFError) as error:
        raise ValueError(f"{path} cannot be read as a point cloud: {str(error).splitlines()[0]}") from error
    return np.ascontiguousarray(points[:, :3])


def reconstruct(points: Floats, depth: int = 8, neighbours: int = 30, trim: float = 0.0) -> Repaired:
    """Screened Poisson surface (Kazhdan and Hoppe 2013) of a point cloud, its normals estimated and oriented.

    Parameters
    ----------
    points : (n, 3)
    depth : int
        Levels of the octree: the finest cell is 2^-depth of the cloud's extent.
    neighbours : int
        Points from which a normal is estimated and along which its orientation spreads.
    trim : float
        Share of the vertices, those with the least points around, whose faces are removed; for scans with open edges.

    Returns
    -------
    Repaired
        The largest component, repaired.

    Raises
    ------
    ValueError
        If there are fewer points than neighbours, or open3d is missing.
    """
    if len(points) <= neighbours:
        raise ValueError(f"point cloud has {len(points)} points; more than neighbours = {neighbours} are needed")
    open3d = import_open3d()
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(np.array(points)))
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(neighbours))
    cloud.orient_normals_consistent_tangent_plane(neighbours)
    # with several threads the sums, and so the last bits, depend on chance
    mesh, density = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth=depth, n_threads=1)
    vertices, faces = np.array(mesh.vertices), np.array(mesh.triangles, dtype=np.int64)
    sparse = np.asarray(density) < np.quantile(density, trim)
    return repair(vertices, faces[~sparse[faces].any(axis=1)] if trim > 0 else faces, largest_component=True)
