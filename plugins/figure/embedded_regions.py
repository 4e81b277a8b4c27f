"""Sulcal regions of two cortices in space and in the optimal embedding, figures 6.4 to 6.6."""

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.embedding.distance import Distance
from surfexp.figures.figure import Figure
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.studies.sulci.sulcal_regions import OUTSIDE, names_by_majority

# widest extent of each cortex and of the larger embedding in the figure
EXTENTS = (1.0, 0.9)


@register("figure", "embedded_regions")
def embedded_regions_figure(
    source_surface: Surface,
    target_surface: Surface,
    distance: Distance,
    *,
    source_view: Annotated[str, Field(description="direction of view of the source")] = "left",
    target_view: Annotated[str, Field(description="direction of view of the target, turned to its main axes")] = "back",
    view: Annotated[str, Field(description="direction of view of the embeddings")] = "oblique",
    width: Annotated[int, Field(ge=400, le=6000, description="pixels across")] = 1700,
) -> Figure:
    """Regions of two surfaces, in space where poses differ, and in the embedding where like regions meet (6.5)."""
    surfaces = source_surface, target_surface
    labels = [surface.truth.labels for surface in surfaces if surface.truth.labels is not None]
    if len(labels) < 2:
        missing = next(surface.name for surface in surfaces if surface.truth.labels is None)
        raise ValueError(f"{missing} has no labels: make them with the surface sulcal_regions")
    names = names_by_majority(labels[1] - 1, target_surface.mesh.vertex_areas, labels[0] - 1, distance.correspondence)
    colors = [_colors(labels[0]), _colors(np.concatenate([[OUTSIDE], names])[labels[1]] + 1)]
    views = []
    for k, (side, surface) in enumerate(zip(("source", "target"), surfaces, strict=True)):
        vertices = surface.mesh.vertices if k == 0 else _principal(surface.mesh.vertices)
        mesh = _scaled(vertices, surface.mesh.faces, EXTENTS[0] / _extent(vertices))
        shown = (source_view, target_view)[k]
        views.append(SurfaceView(mesh, colors[k], shown, title=f"regions of the {side}"))
    images = distance.source_points[:, :3], distance.target_points[:, :3]
    factor = EXTENTS[1] / max(map(_extent, images))
    for k, (side, points) in enumerate(zip(("source", "target"), images, strict=True)):
        image = _outward(_scaled(points, surfaces[k].mesh.faces, factor))
        views.append(SurfaceView(image, colors[k], view, title=f"embedding of the {side}"))
    caption = (
        f"Sulcal regions of {source_surface.name} and {target_surface.name}, which is turned and scaled: in space, the target "
        "along its main axes, and by the first three functions of the optimal embedding. Colours of the target are those of "
        "the source by majority vote of the nearest neighbours. Compare figures 6.4 to 6.6."
    )
    return replace(surface_panel(views, width=width, caption=caption), title="sulcal regions")


def _principal(vertices: Floats) -> Floats:
    """Coordinates along the main axes: the longest first, the second up."""
    centred = vertices - vertices.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    axes[2] *= np.linalg.det(axes)
    return np.asarray(centred @ axes[[0, 2, 1]].T) * [1.0, -1.0, 1.0]


def _extent(points: Floats) -> float:
    return float(np.ptp(points, axis=0).max())


def _scaled(points: Floats, faces: np.ndarray, factor: float) -> TriangleMesh:
    return TriangleMesh(factor * (points - points.mean(axis=0)), faces)


def _outward(mesh: TriangleMesh) -> TriangleMesh:
    """The mesh with faces that look outward, which signs may have turned."""
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    inside_out = float((mesh.face_cross_products * middles).sum()) < 0.0
    return TriangleMesh(mesh.vertices, mesh.faces[:, ::-1]) if inside_out else mesh


def _colors(labels: np.ndarray) -> Floats:
    """Light grey for 0, then colours by turns of the golden angle in hue at three brightnesses."""
    from matplotlib.colors import hsv_to_rgb

    k = labels.astype(float)
    hues = np.stack([(0.618034 * k) % 1.0, 0.6 + 0.25 * (k % 2), 0.95 - 0.2 * (k % 3)], axis=1)
    return np.where((labels > 0)[:, None], np.asarray(hsv_to_rgb(hues)), 0.85)
