"""Surfaces, their first eigenfunctions, and their images under three of them, figure 6.1."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.figures.camera import VIEWS, view_axes
from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure, compare
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.spectrum.eigensystem import EigenSystem

IMAGE_VIEW = "oblique"


@register("figure", "embedded_surfaces")
def embedded_surfaces_figure(
    surfaces: dict[str, Surface],
    systems: dict[str, EigenSystem],
    *,
    view: Annotated[str, Field(description="direction of view of the surfaces")] = "left",
    reference: Annotated[str, Field(description="figure of the dissertation that this one answers")] = "",
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1700,
) -> Figure:
    """The first three eigenfunctions on each surface and its image under them, all at one scale (figure 6.1)."""
    points = {
        label: spectral_embedding(systems[label], surface.mesh.vertex_areas, 3).points
        for label, surface in surfaces.items()
    }
    largest = max(float(np.abs(values).max()) for values in points.values())
    scale = ColorScale(label="global point coordinate", colormap="RdBu_r", limits=(-largest, largest))
    rows = []
    for label, surface in surfaces.items():
        mesh = TriangleMesh(surface.mesh.vertices / np.sqrt(surface.mesh.area), surface.mesh.faces)
        columns = [np.ascontiguousarray(points[label][:, k]) for k in range(3)]
        views = [
            SurfaceView(mesh, values, view, scale, (), f"{label}, eigenfunction {k}")
            for k, values in enumerate(columns, 1)
        ]
        image, kept = facing(TriangleMesh(points[label], mesh.faces), view_axes(*VIEWS[IMAGE_VIEW])[2])
        rows.append([*views, SurfaceView(image, columns[0][kept], IMAGE_VIEW, scale, (), f"image of the {label}")])
    caption = (
        "The first three eigenfunctions over the square roots of their eigenvalues, on surfaces of area 1, and the images of "
        "the surfaces with these as coordinates (6.4), in the colours of the first; one scale for all lengths and colours."
        f"{compare(reference)}"
    )
    return surface_panel(rows, width=width, caption=caption)


def facing(mesh: TriangleMesh, toward: Floats) -> tuple[TriangleMesh, np.ndarray]:
    """Return a mesh whose faces all show their outer side to the eye, with vertices of their own, and their old rows."""
    behind = mesh.face_normals @ toward < 0.0
    faces = np.where(behind[:, None], mesh.faces[:, ::-1] + len(mesh.vertices), mesh.faces)
    kept, rows = np.unique(faces, return_inverse=True)
    kept = kept % len(mesh.vertices)
    return TriangleMesh(mesh.vertices[kept], rows.reshape(-1, 3).astype(np.int64)), kept
