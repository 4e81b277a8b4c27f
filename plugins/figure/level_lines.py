"""A level line before and after a flow."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

from pydantic import Field

from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, sentence
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


@register("figure", "level_lines")
def level_lines_figure(
    surface: Surface,
    image: Image,
    solver: Solution,
    *,
    level: Annotated[float, Field(ge=-1000000000000.0, le=1000000000000.0, description="level of the line")] = 0.0,
    views: Annotated[Sequence[str], Field(description="directions of view")] = ["left", "oblique"],
    line_width: Annotated[float, Field(gt=0, le=20, description="width of the lines in pixels")] = 3.0,
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1400,
) -> Figure:
    """The line of one level before (grey) and after a flow (red), from several sides."""
    lines = tuple(
        Contours(field, (level,), colour, line_width)
        for field, colour in ((image.values, "#4d4d4d"), (solver.values, "#d7191c"))
    )
    panels = [SurfaceView(surface.mesh, None, view, contours=lines) for view in views]
    caption = f"{sentence(surface.name)}: a level line before (grey) and after (red) the {solver.model}."
    return replace(surface_panel(panels, width=width, caption=caption), title=f"{surface.name} · {solver.model}")
