"""Clean, observed and restored image and what is left, for denoising, deblurring and inpainting, grey or coloured."""

from dataclasses import replace

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure, compare, noun, sentence
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution

LOST = np.array([0.84, 0.38, 0.30])


class Restoration(Options):
    """The viewpoint, and where the picture is published."""

    azimuth: float = Field(-80.0, ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    elevation: float = Field(12.0, ge=-90, le=90, description="height of view, degrees")
    reference: str = Field("", description="equation or figure of the dissertation that this one answers")
    colormap: str = Field("gray", description="matplotlib's name of the colour map of the image")
    width: int = Field(1800, ge=200, le=8000, description="pixels across")


@register("figure", "restoration")
def restoration_figure(
    options: Restoration, *, surface: Surface, image: Image, operator: SurfaceOperator, solver: Solution
) -> Figure:
    """Clean, observed and restored image and the error, lost parts in red; three channels as colours."""
    scale = ColorScale(label=image.name, unit=image.unit, colormap=options.colormap, percentiles=(0.0, 100.0))
    scale = scale.fitted(solver.values if image.clean is None else image.clean)
    low, high = scale.limits or (0.0, 1.0)

    def colours(values: Floats) -> Floats:
        return np.clip((values - low) / (high - low), 0.0, 1.0) if values.ndim == 2 else scale.rgb(values)

    def panel(values: Floats, name: str) -> SurfaceView:
        flat = values.ndim == 1
        return SurfaceView(
            surface.mesh, values if flat else colours(values), view, scale if flat else ColorScale(), (), name
        )

    view = (options.azimuth, options.elevation)
    observed = panel(image.values, "observed")
    if image.known is not None:
        seen = np.where(image.known[:, None], colours(image.values), LOST)
        observed = SurfaceView(surface.mesh, seen, view, ColorScale(), (), "observed")
    panels = [observed, panel(solver.values, "restored")]
    if image.clean is not None:
        error = (solver.values - image.clean).reshape(len(image.clean), -1).mean(axis=1)
        bound = max(float(np.percentile(np.abs(error), 99)), 1e-12)
        signed = ColorScale(label="error", colormap="RdBu_r", limits=(-bound, bound))
        panels.insert(0, panel(image.clean, "clean"))
        panels.append(SurfaceView(surface.mesh, error, view, signed, (), "error"))
    where = compare(options.reference)
    error_text = f"; error {solver.metrics['rmse']:.3g}" if "rmse" in solver.metrics else ""
    caption = f"{sentence(image.name)} on {noun(surface.name)}: {solver.model}{error_text}.{where}"
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.model, solver.solver))
    return replace(surface_panel(panels, width=options.width, caption=caption), title=title)
