"""A surface reconstructed from points."""

from pathlib import Path

from pydantic import Field

from surfexp.io.point_cloud import read_points, reconstruct
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface


class PointCloud(Options):
    """The file, and how its points become a surface."""

    path: Path = Field(description=".xyz, .npy, .pcd or .ply file of points")
    depth: int = Field(8, ge=2, le=14, description="depth of the octree: each step doubles the resolution")
    neighbours: int = Field(30, ge=3, le=500, description="points from which a normal is estimated")
    trim: float = Field(0.0, ge=0, lt=1, description="share of the least supported vertices to cut away")
    unit: str = Field("", description="unit of length, for captions")


@register("surface", "point_cloud")
def point_cloud_surface(options: PointCloud) -> Surface:
    """Screened Poisson surface of a point cloud, normals estimated (through open3d)."""
    repaired = reconstruct(read_points(options.path), options.depth, options.neighbours, options.trim)
    return Surface(repaired.mesh, options.path.stem, options.unit, notes=tuple(repaired.changes))
