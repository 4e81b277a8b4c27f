"""A denoised image as figure 2.2 shows one: clean, noisy, denoised, residual."""

from dataclasses import replace
from typing import Annotated

from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure, compare, noun, sentence
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution

# channels that are drawn as red, green and blue
COLORS = 3


@register("figure", "denoising")
def denoising_figure(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    solver: Solution,
    *,
    azimuth: Annotated[
        float, Field(ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    ] = -80.0,
    elevation: Annotated[float, Field(ge=-90, le=90, description="height of view, degrees")] = 12.0,
    reference: Annotated[str, Field(description="figure of the dissertation that this one answers")] = "",
    colormap: Annotated[str, Field(description="matplotlib's name of the colour map of the image")] = "gray",
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1800,
) -> Figure:
    """Clean, noisy and denoised image and the residual, from one side, on the scale of the data.

    Of an image of many channels, as a time series, the first is drawn.
    """
    channels = image.values.shape[1] if image.values.ndim == 2 else 1
    if channels not in (1, COLORS):
        clean = None if image.clean is None else image.clean[:, 0]
        image = replace(image, values=image.values[:, 0], clean=clean, name=f"{image.name}, channel 1 of {channels}")
        solver = replace(solver, values=solver.values[:, 0])
    view = (azimuth, elevation)
    shown = ColorScale(label=image.name, unit=image.unit, colormap=colormap, percentiles=(0.0, 100.0))
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
        f"{compare(reference)}"
    )
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.solver))
    return replace(surface_panel(views, width=width, caption=caption), title=title)
