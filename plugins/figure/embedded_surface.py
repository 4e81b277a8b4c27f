"""A surface, its first eigenfunctions, and its embedding by three of them, figure 6.1."""

from dataclasses import replace

import numpy as np
from pydantic import Field

from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.workflow.registry import Options, register


class EmbeddedSurface(Options):
    """View and size."""

    view: str = Field("left", description="direction of view")
    width: int = Field(1700, ge=200, le=8000, description="pixels across")


@register("figure", "embedded_surface")
def embedded_surface_figure(options: EmbeddedSurface, *, surface: Surface, eigensolver: EigenSystem) -> Figure:
    """The first three eigenfunctions on the surface and the image of the surface under them (figure 6.1)."""
    mesh = surface.mesh
    points = spectral_embedding(eigensolver, mesh.vertex_areas, 3).points
    largest = float(np.abs(points).max())
    scale = ColorScale(label="global point coordinate", colormap="RdBu_r", limits=(-largest, largest))
    views = [
        SurfaceView(mesh, np.ascontiguousarray(points[:, k]), options.view, scale, (), f"eigenfunction {k + 1}")
        for k in range(3)
    ]
    size = 0.8 * float(np.ptp(mesh.vertices, axis=0).max() / np.ptp(points, axis=0).max())
    image = TriangleMesh(size * points, mesh.faces)
    views.append(SurfaceView(image, np.ascontiguousarray(points[:, 0]), "oblique", scale, (), "image of the surface"))
    caption = (
        f"{surface.name}: the first three eigenfunctions over the square roots of their eigenvalues, and the surface that has "
        "them as coordinates (6.4), enlarged. Compare figure 6.1."
    )
    return replace(surface_panel(views, width=options.width, caption=caption), title=surface.name)
