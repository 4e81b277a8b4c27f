"""Clean, observed and restored image and what is left, for denoising, deblurring and inpainting, grey or coloured."""

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.arrays import Floats
from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure, compare, noun, sentence
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution

LOST = np.array([0.84, 0.38, 0.30])


@register("figure", "restoration")
def restoration_figure(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    solver: Solution,
    *,
    azimuth: Annotated[
        float, Field(ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    ] = -80.0,
    elevation: Annotated[float, Field(ge=-90, le=90, description="height of view, degrees")] = 12.0,
    reference: Annotated[str, Field(description="equation or figure of the dissertation that this one answers")] = "",
    colormap: Annotated[str, Field(description="matplotlib's name of the colour map of the image")] = "gray",
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1800,
) -> Figure:
    """Clean, observed and restored image and the error, lost parts in red; three channels as colours."""
    scale = ColorScale(label=image.name, unit=image.unit, colormap=colormap, percentiles=(0.0, 100.0))
    scale = scale.fitted(solver.values if image.clean is None else image.clean)
    low, high = scale.limits or (0.0, 1.0)

    def colours(values: Floats) -> Floats:
        return np.clip((values - low) / (high - low), 0.0, 1.0) if values.ndim == 2 else scale.rgb(values)

    def panel(values: Floats, name: str) -> SurfaceView:
        flat = values.ndim == 1
        return SurfaceView(
            surface.mesh, values if flat else colours(values), view, scale if flat else ColorScale(), (), name
        )

    view = (azimuth, elevation)
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
    where = compare(reference)
    error_text = f"; error {solver.metrics['rmse']:.3g}" if "rmse" in solver.metrics else ""
    caption = f"{sentence(image.name)} on {noun(surface.name)}: {solver.model}{error_text}.{where}"
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.model, solver.solver))
    return replace(surface_panel(panels, width=width, caption=caption), title=title)
