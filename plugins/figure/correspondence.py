"""A map between surfaces in colours."""

from collections.abc import Sequence
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


@register("figure", "correspondence")
def correspondence_figure(
    source_surface: Surface,
    target_surface: Surface,
    distance: Distance,
    *,
    source_views: Annotated[Sequence[str], Field(description="directions of view of the source")] = ["left"],
    target_views: Annotated[Sequence[str], Field(description="directions of view of the target")] = ["left"],
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1700,
) -> Figure:
    """The labels of the source, or its positions as colours, carried to the target; errors of labels in black."""
    source_labels, target_labels = source_surface.truth.labels, target_surface.truth.labels
    if source_labels is not None:
        colors = _palette(int(source_labels.max()) + 1)[source_labels]
    else:
        vertices = source_surface.mesh.vertices
        colors = 0.15 + 0.8 * (vertices - vertices.min(axis=0)) / np.ptp(vertices, axis=0)
    carried = colors[distance.correspondence]
    views = [SurfaceView(source_surface.mesh, colors, view, title="source") for view in source_views]
    views += [SurfaceView(target_surface.mesh, carried, view, title="carried") for view in target_views]
    accuracy = distance.metrics.get("label accuracy")
    if accuracy is not None and source_labels is not None and target_labels is not None:
        wrong = source_labels[distance.correspondence] != target_labels
        shown = np.where(wrong[:, None], 0.12, carried)
        views += [SurfaceView(target_surface.mesh, shown, view, title="wrong ones black") for view in target_views]
    share = f"; {100 * accuracy:.1f} % of the area is named right" if accuracy is not None else ""
    caption = f"{source_surface.name} carried to {target_surface.name} by {distance.method}{share}."
    return replace(surface_panel(views, width=width, caption=caption), title=distance.method)


def _palette(count: int) -> Floats:
    """Colours far apart, by turns of the golden angle in hue at three brightnesses."""
    from matplotlib.colors import hsv_to_rgb

    k = np.arange(count)
    hues = (0.618034 * k) % 1.0
    return np.asarray(hsv_to_rgb(np.stack([hues, 0.55 + 0.3 * (k % 2), 0.95 - 0.17 * (k % 3)], axis=1)))
