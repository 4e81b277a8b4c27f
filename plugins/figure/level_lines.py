"""A level line before and after a flow."""

from dataclasses import replace

from pydantic import Field

from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, sentence
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


class LevelLines(Options):
    """The level, the viewpoints and the lines."""

    level: float = Field(0.0, ge=-1e12, le=1e12, description="level of the line")
    views: list[str] = Field(["left", "oblique"], description="directions of view")
    line_width: float = Field(3.0, gt=0, le=20, description="width of the lines in pixels")
    width: int = Field(1400, ge=200, le=8000, description="pixels across")


@register("figure", "level_lines")
def level_lines_figure(options: LevelLines, *, surface: Surface, image: Image, solver: Solution) -> Figure:
    """The line of one level before (grey) and after a flow (red), from several sides."""
    lines = tuple(
        Contours(field, (options.level,), colour, options.line_width)
        for field, colour in ((image.values, "#4d4d4d"), (solver.values, "#d7191c"))
    )
    views = [SurfaceView(surface.mesh, None, view, contours=lines) for view in options.views]
    caption = f"{sentence(surface.name)}: a level line before (grey) and after (red) the {solver.model}."
    return replace(surface_panel(views, width=options.width, caption=caption), title=f"{surface.name} · {solver.model}")
