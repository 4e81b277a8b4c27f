"""The picture of figures 2.3 to 2.6: image, segmentation, red contours."""

from dataclasses import replace

import numpy as np
from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, compare, noun, sentence
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.images.initial_curves import disc_distance
from surfexp.variational.solution import Solution

LIGHT, DARK = np.array([0.96, 0.92, 0.84]), np.array([0.30, 0.38, 0.50])


class Segmentation(Options):
    """The viewpoints, the initial curve that is drawn too, and the lines."""

    views: list[tuple[float, float]] = Field(
        [(-100.0, 12.0), (-40.0, 12.0)], description="directions of view: azimuth and elevation, degrees"
    )
    reference: str = Field("", description="figure of the dissertation that this one answers")
    discs: int = Field(0, ge=0, le=10000, description="initial curve as the model has it; 0: not drawn")
    radius: float = Field(10.0, gt=0, description="radius of an initial circle in edge lengths")
    seed: int = Field(0, ge=0, description="seed of the initial circles")
    line_width: float = Field(2.5, gt=0, le=20, description="width of the red lines in pixels")
    colormap: str = Field("gray", description="matplotlib's name of the colour map of the image")
    width: int = Field(1800, ge=200, le=8000, description="pixels across")


@register("figure", "segmentation")
def segmentation_figure(
    options: Segmentation, *, surface: Surface, image: Image, operator: SurfaceOperator, solver: Solution
) -> Figure:
    """The image with the initial curve, the result, and the image with the boundary found, from each side."""
    mesh, scale = surface.mesh, ColorScale(image.name, image.unit, options.colormap)
    start: tuple[Contours, ...] = ()
    if options.discs:
        distance = disc_distance(mesh, options.discs, options.radius * mesh.edge_length, options.seed)
        start = (Contours(distance, width=options.line_width),)
    field, level = solver.boundary
    edges = (Contours(field, levels=(level,), width=options.line_width),)
    inside = np.asarray(solver.segmentation, dtype=float)[:, None]
    regions = inside * LIGHT + (1.0 - inside) * DARK
    rows = [
        [
            SurfaceView(mesh, image.values, view, scale, start, "image and initial curve" if start else "image"),
            SurfaceView(mesh, regions, view, title="regions"),
            SurfaceView(mesh, image.values, view, scale, edges, "boundary on the image"),
        ]
        for view in options.views
    ]
    noise = f" with noise of standard deviation {image.noise:g}" if image.noise else ""
    where = compare(options.reference)
    caption = (
        f"{sentence(image.name)} on {noun(surface.name)}, {len(mesh.vertices):,} vertices{noise}; in red the boundary, "
        f"{solver.metrics['perimeter']:.3g} long.{where}"
    )
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.solver))
    return replace(surface_panel(rows, width=options.width, caption=caption), title=title)
