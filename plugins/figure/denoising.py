"""The picture of figure 2.2: clean, noisy, denoised, residual."""

from dataclasses import replace

from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution
from surfexp.workflow.registry import Options, register


class Denoising(Options):
    """The viewpoint and the width of the figure."""

    azimuth: float = Field(-80.0, ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    elevation: float = Field(12.0, ge=-90, le=90, description="height of view, degrees")
    width: int = Field(1800, ge=200, le=8000, description="pixels across")


@register("figure", "denoising")
def denoising_figure(
    options: Denoising, *, surface: Surface, image: Image, operator: SurfaceOperator, solver: Solution
) -> Figure:
    """Clean, noisy and denoised image and the residual, from one side (figure 2.2)."""
    view = (options.azimuth, options.elevation)
    grey = ColorScale(label="grey level", colormap="gray", limits=(0.0, 255.0))
    spread = 2.5 * image.noise if image.noise else None
    signed = ColorScale(label="residual", colormap="RdBu_r", limits=(-spread, spread) if spread else None)
    residual = image.values - solver.values
    panels = [("noisy", image.values, grey), ("denoised", solver.values, grey), ("residual", residual, signed)]
    if image.clean is not None:
        panels.insert(0, ("clean", image.clean, grey))
    views = [SurfaceView(surface.mesh, values, view, scale, (), name) for name, values, scale in panels]
    caption = (
        f"The {image.name} on a {surface.name}, standing in for the Lena image of figure 2.2 of the dissertation: "
        f"noise of standard deviation {image.noise:g} of 0..255, {operator.name.replace('_', ' ')} operator."
    )
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.solver))
    return replace(surface_panel(views, width=options.width, caption=caption), title=title)
