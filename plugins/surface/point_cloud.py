"""A surface reconstructed from points."""

from pathlib import Path
from typing import Annotated

from pydantic import Field

from surfexp.io.point_cloud import read_points, reconstruct
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface


@register("surface", "point_cloud", defaults_of=reconstruct)
def point_cloud_surface(
    *,
    path: Annotated[Path, Field(description=".xyz, .npy, .pcd or .ply file of points")],
    depth: Annotated[int, Field(ge=2, le=14, description="depth of the octree: each step doubles the resolution")],
    neighbours: Annotated[int, Field(ge=3, le=500, description="points from which a normal is estimated")],
    trim: Annotated[float, Field(ge=0, lt=1, description="share of the least supported vertices to cut away")],
    unit: Annotated[str, Field(description="unit of length, for captions")] = "",
) -> Surface:
    """Screened Poisson surface of a point cloud, normals estimated (through open3d)."""
    repaired = reconstruct(read_points(path), depth, neighbours, trim)
    return Surface(repaired.mesh, path.stem, unit, notes=tuple(repaired.changes))
