"""A denoised image as figure 2.2 shows one: clean, noisy, denoised, residual."""

from dataclasses import replace

from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure, compare, noun, sentence
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


class Denoising(Options):
    """The viewpoint and the width of the figure."""

    azimuth: float = Field(-80.0, ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    elevation: float = Field(12.0, ge=-90, le=90, description="height of view, degrees")
    reference: str = Field("", description="figure of the dissertation that this one answers")
    colormap: str = Field("gray", description="matplotlib's name of the colour map of the image")
    width: int = Field(1800, ge=200, le=8000, description="pixels across")


@register("figure", "denoising")
def denoising_figure(
    options: Denoising, *, surface: Surface, image: Image, operator: SurfaceOperator, solver: Solution
) -> Figure:
    """Clean, noisy and denoised image and the residual, from one side, on the scale of the data."""
    view = (options.azimuth, options.elevation)
    shown = ColorScale(label=image.name, unit=image.unit, colormap=options.colormap, percentiles=(0.0, 100.0))
    # one scale for all panels, that of the least noisy image; noise beyond it is black and white
    shown = shown.fitted(solver.values if image.clean is None else image.clean)
    spread = 2.5 * image.noise if image.noise else None
    signed = ColorScale("residual", image.unit, "RdBu_r", (-spread, spread) if spread else None)
    residual = image.values - solver.values
    panels = [("noisy", image.values, shown), ("denoised", solver.values, shown), ("residual", residual, signed)]
    if image.clean is not None:
        panels.insert(0, ("clean", image.clean, shown))
    views = [SurfaceView(surface.mesh, values, view, scale, (), name) for name, values, scale in panels]
    noise = f"noise of standard deviation {image.noise:g} {image.unit}".rstrip() if image.noise else "noise unknown"
    caption = (
        f"{sentence(image.name)} on {noun(surface.name)}: {noise}, {operator.name.replace('_', ' ')} operator."
        f"{compare(options.reference)}"
    )
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.solver))
    return replace(surface_panel(views, width=options.width, caption=caption), title=title)
