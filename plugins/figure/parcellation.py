"""The picture of figure 2.8: curvature in colour, the boundary of the regions in red."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

from pydantic import Field

from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, compare, sentence, whole
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


@register("figure", "parcellation", defaults_of=surface_panel)
def parcellation_figure(
    surface: Surface,
    image: Image,
    operator: SurfaceOperator,
    solver: Solution,
    *,
    views: Annotated[Sequence[str], Field(description="directions of view")] = ["lateral", "medial"],
    colormap: Annotated[str, Field(description="matplotlib's name of the colour map of the image")] = "PuOr_r",
    line_width: Annotated[float, Field(gt=0, le=20, description="width of the red line in pixels")] = 3.0,
    reference: Annotated[str, Field(description="figure of the dissertation that this one answers")] = "",
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")],
) -> Figure:
    """The image in colour with the boundary of the segmented regions in red, from several sides (figure 2.8)."""
    ends = any("clipped" in note for note in image.notes)
    scale = ColorScale(label=image.name, unit=image.unit, colormap=colormap, clipped=ends)
    field, level = solver.boundary
    contours = (Contours(field, levels=(level,), width=line_width),)
    panels = [SurfaceView(surface.mesh, image.values, view, scale, contours, view) for view in views]
    length = solver.metrics.get("perimeter")
    gap = solver.metrics.get("labelling_gap")
    proved = (
        f" For these two means at least {1.0 - gap:.1%} of what any labelling can gain over the best trivial one "
        "is gained; nothing is proved about the means."
        if gap is not None
        else ""
    )
    # the colours end where the image was clipped
    clipped = "".join(f" {sentence(note)}." for note in image.notes)
    caption = (
        f"{surface.name}: {image.name}, and in red the boundary of the regions found by {solver.model.replace('_', ' ')}"
        f"{f', {whole(length)} {surface.unit} long' if length is not None else ''}.{clipped}{proved}{compare(reference)}"
    )
    title = " · ".join(name.replace("_", " ") for name in (operator.name, solver.solver, surface.name))
    return replace(surface_panel(panels, width=width, caption=caption), title=title)
