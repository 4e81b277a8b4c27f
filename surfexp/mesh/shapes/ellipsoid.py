"""The ellipsoid."""

from __future__ import annotations

import numpy as np

from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def ellipsoid(levels: int = 4, semiaxes: tuple[float, float, float] = (1.0, 1.3, 0.8)) -> Surface:
    """Icosphere stretched to the given semiaxes; `coordinates` are the sphere's longitude and latitude.

    Raises
    ------
    ValueError
        If a semiaxis is not positive.
    """
    if min(semiaxes) <= 0:
        raise ValueError(f"ellipsoid has semiaxes {semiaxes}; all have to be positive")
    sphere = icosphere(levels)
    mesh = TriangleMesh(sphere.mesh.vertices * np.array(semiaxes), sphere.mesh.faces)
    return with_metrics(Surface(mesh, name="ellipsoid", coordinates=sphere.coordinates))
