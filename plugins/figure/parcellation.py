"""The picture of figure 2.8: curvature in colour, the boundary of the regions in red."""

from dataclasses import replace

from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, compare
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


class Parcellation(Options):
    """The viewpoints, colours and lines."""

    views: list[str] = Field(["lateral", "medial"], description="directions of view")
    colormap: str = Field("PuOr_r", description="matplotlib's name of the colour map of the image")
    line_width: float = Field(3.0, gt=0, le=20, description="width of the red line in pixels")
    reference: str = Field("", description="figure of the dissertation that this one answers")
    width: int = Field(1600, ge=200, le=8000, description="pixels across")


@register("figure", "parcellation")
def parcellation_figure(
    options: Parcellation, *, surface: Surface, image: Image, operator: SurfaceOperator, solver: Solution
) -> Figure:
    """The image in colour with the boundary of the segmented regions in red, from several sides (figure 2.8)."""
    scale = ColorScale(label=image.name, unit=image.unit, colormap=options.colormap)
    field, level = solver.boundary
    contours = (Contours(field, levels=(level,), width=options.line_width),)
    views = [SurfaceView(surface.mesh, image.values, view, scale, contours, view) for view in options.views]
    length = solver.metrics.get("perimeter")
    gap = solver.metrics.get("labelling_gap")
    proved = (
        f" For these two means at least {1.0 - gap:.1%} of what any labelling can gain over the best trivial one "
        "is gained; nothing is proved about the means."
        if gap is not None
        else ""
    )
    caption = (
        f"{surface.name}: {image.name}, and in red the boundary of the regions found by {solver.model.replace('_', ' ')}"
        f"{f', {length:,.0f} {surface.unit} long' if length is not None else ''}.{proved}{compare(options.reference)}"
    )
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.solver, surface.name))
    return replace(surface_panel(views, width=options.width, caption=caption), title=title)
