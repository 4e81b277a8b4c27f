"""Segmentation into several regions: the image, its regions in their mean colours, and their boundaries."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, noun, sentence, whole
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


@register("figure", "regions")
def regions_figure(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    solver: Solution,
    *,
    views: Annotated[
        Sequence[tuple[float, float]], Field(description="directions of view: azimuth and elevation, degrees")
    ] = [(-100.0, 12.0), (-40.0, 12.0)],
    line_width: Annotated[float, Field(gt=0, le=20, description="width of the red lines in pixels")] = 2.5,
    colormap: Annotated[str, Field(description="matplotlib's name of the colour map of the image")] = "gray",
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1800,
) -> Figure:
    """The image, each region in the mean colour of the image on it, and the boundaries in red, from each side."""
    if solver.segmentation is None:
        raise ValueError(f"{solver.model} has no regions; take a segmentation")
    mesh, labels = surface.mesh, np.asarray(solver.segmentation).astype(np.int64)
    means = np.zeros_like(image.values)
    for label in np.unique(labels):
        part = labels == label
        means[part] = np.average(image.values[part], axis=0, weights=operator.mass[part])
    colour = image.values.ndim == 2
    shown, flat = ((np.clip(a / 255.0, 0.0, 1.0) if colour else a) for a in (image.values, means))
    scale = ColorScale(image.name, image.unit, colormap)
    lines = tuple(
        Contours((labels == label).astype(np.float64), levels=(0.5,), width=line_width)
        for label in np.unique(labels)[1:]
    )
    rows = [
        [
            SurfaceView(mesh, shown, view, scale, title="image"),
            SurfaceView(mesh, flat, view, scale, title="regions in their mean colours"),
            SurfaceView(mesh, shown, view, scale, lines, "boundaries on the image"),
        ]
        for view in views
    ]
    noise = f" with noise of standard deviation {image.noise:g}" if image.noise else ""
    caption = (
        f"{sentence(image.name)} on {noun(surface.name)}, {whole(len(mesh.vertices))} vertices{noise}: "
        f"{len(np.unique(labels))} regions; in red their boundaries."
    )
    return replace(surface_panel(rows, width=width, caption=caption), title=solver.solver.replace("_", " "))
