"""Noise on the vertices of a surface."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def add_vertex_noise(
    surface: Surface, sigma: float, seed: int = 0, direction: Literal["all", "normal"] = "all"
) -> Surface:
    """Move every vertex by a Gaussian of standard deviation `sigma` in each coordinate, or along its normal.

    Raises
    ------
    ValueError
        If sigma is negative or the direction unknown.
    """
    if not sigma >= 0 or direction not in ("all", "normal"):
        raise ValueError(
            f"vertex noise has sigma = {sigma}, direction = {direction!r}; sigma >= 0, all or normal are needed"
        )
    mesh, random = surface.mesh, np.random.default_rng(seed)
    if direction == "all":
        shift = random.normal(0.0, sigma, mesh.vertices.shape)
    else:
        shift = mesh.vertex_normals * random.normal(0.0, sigma, (len(mesh.vertices), 1))
    note = f"vertices carry Gaussian noise of standard deviation {sigma:g} (seed {seed}, direction: {direction})"
    moved = TriangleMesh(mesh.vertices + shift, mesh.faces)
    noisy = surface.deformed(moved) if sigma > 0 else surface
    return with_metrics(replace(noisy, notes=(*surface.notes, note)))
