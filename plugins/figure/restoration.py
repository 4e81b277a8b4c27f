"""Clean, observed and restored image and what is left, for denoising, deblurring and inpainting, grey or coloured."""

from dataclasses import replace

import numpy as np
from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.figure import Figure
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution
from surfexp.workflow.registry import Options, register

LOST = np.array([214.0, 96.0, 77.0])


class Restoration(Options):
    """The viewpoint, and where the picture is printed."""

    azimuth: float = Field(-80.0, ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    elevation: float = Field(12.0, ge=-90, le=90, description="height of view, degrees")
    reference: str = Field("", description="equation or figure of the dissertation that this one answers")
    width: int = Field(1800, ge=200, le=8000, description="pixels across")


@register("figure", "restoration")
def restoration_figure(
    options: Restoration, *, surface: Surface, image: Image, operator: SurfaceOperator, solver: Solution
) -> Figure:
    """Clean, observed and restored image and the error, lost parts in red; three channels as colours."""
    grey = ColorScale(label="grey level", colormap="gray", limits=(0.0, 255.0))

    def panel(values: Floats, name: str) -> SurfaceView:
        shown = np.clip(values / 255.0, 0.0, 1.0) if values.ndim == 2 else values
        return SurfaceView(surface.mesh, shown, view, ColorScale() if values.ndim == 2 else grey, (), name)

    view = (options.azimuth, options.elevation)
    observed = image.values
    if image.known is not None:
        levels = observed if observed.ndim == 2 else np.repeat(observed[:, None], 3, axis=1)
        observed = np.where(image.known[:, None], levels, LOST)
    panels = [panel(observed, "observed"), panel(solver.values, "restored")]
    if image.clean is not None:
        error = (solver.values - image.clean).reshape(len(image.clean), -1).mean(axis=1)
        bound = max(float(np.percentile(np.abs(error), 99)), 1e-12)
        signed = ColorScale(label="error", colormap="RdBu_r", limits=(-bound, bound))
        panels.insert(0, panel(image.clean, "clean"))
        panels.append(SurfaceView(surface.mesh, error, view, signed, (), "error"))
    where = f" Compare {options.reference} of the dissertation." if options.reference else ""
    error_text = f"; error {solver.metrics['rmse']:.3g}" if "rmse" in solver.metrics else ""
    caption = f"{image.name.capitalize()} on a {surface.name}: {solver.model}{error_text}.{where}"
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.model, solver.solver))
    return replace(surface_panel(panels, width=options.width, caption=caption), title=title)
