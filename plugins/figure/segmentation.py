"""The picture of figures 2.3 to 2.6: image, segmentation, red contours."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, compare, noun, sentence, whole
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.images.initial_curves import disc_distance
from surfexp.variational.solution import Solution

LIGHT, DARK = np.array([0.96, 0.92, 0.84]), np.array([0.30, 0.38, 0.50])


@register("figure", "segmentation", defaults_of=disc_distance)
def segmentation_figure(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    solver: Solution,
    *,
    views: Annotated[
        Sequence[tuple[float, float]], Field(description="directions of view: azimuth and elevation, degrees")
    ] = [(-100.0, 12.0), (-40.0, 12.0)],
    reference: Annotated[str, Field(description="figure of the dissertation that this one answers")] = "",
    discs: Annotated[int, Field(ge=0, le=10000, description="initial curve as the model has it; 0: not drawn")] = 0,
    radius: Annotated[float, Field(gt=0, description="radius of an initial circle in edge lengths")] = 10.0,
    seed: Annotated[int, Field(ge=0, description="seed of the initial circles")],
    line_width: Annotated[float, Field(gt=0, le=20, description="width of the red lines in pixels")] = 2.5,
    colormap: Annotated[str, Field(description="matplotlib's name of the colour map of the image")] = "gray",
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1800,
) -> Figure:
    """The image with the initial curve, the result, and the image with the boundary found, from each side."""
    mesh, scale = surface.mesh, ColorScale(image.name, image.unit, colormap)
    start: tuple[Contours, ...] = ()
    if discs:
        distance = disc_distance(mesh, discs, radius * mesh.edge_length, seed)
        start = (Contours(distance, width=line_width),)
    field, level = solver.boundary
    edges = (Contours(field, levels=(level,), width=line_width),)
    inside = np.asarray(solver.segmentation, dtype=float)[:, None]
    regions = inside * LIGHT + (1.0 - inside) * DARK
    rows = [
        [
            SurfaceView(mesh, image.values, view, scale, start, "image and initial curve" if start else "image"),
            SurfaceView(mesh, regions, view, title="regions"),
            SurfaceView(mesh, image.values, view, scale, edges, "boundary on the image"),
        ]
        for view in views
    ]
    noise = f" with noise of standard deviation {image.noise:g}" if image.noise else ""
    where = compare(reference)
    caption = (
        f"{sentence(image.name)} on {noun(surface.name)}, {whole(len(mesh.vertices))} vertices{noise}; in red the boundary, "
        f"{solver.metrics['perimeter']:.3g} long.{where}"
    )
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.solver))
    return replace(surface_panel(rows, width=width, caption=caption), title=title)
