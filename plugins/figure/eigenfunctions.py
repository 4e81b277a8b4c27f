"""Eigenfunctions and their nodal lines, figures 3.1, 4.3 and 4.4."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

from pydantic import Field

from surfexp.figures.boundary_line import INSIDE, barycentric, without_rim
from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, compare, noun
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.figures.typography import INK, QUIET
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem


@register("figure", "eigenfunctions", defaults_of=surface_panel)
def eigenfunctions_figure(
    surface: Surface,
    eigensolver: EigenSystem,
    *,
    modes: Annotated[Sequence[int], Field(description="which modes, counted from 0")] = [1, 2, 3, 4, 5, 10, 20, 40],
    azimuth: Annotated[
        float, Field(ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    ] = -60.0,
    elevation: Annotated[float, Field(ge=-90, le=90, description="height of view, degrees")] = 20.0,
    columns: Annotated[int, Field(ge=1, le=12, description="pictures in a row")] = 4,
    line_width: Annotated[float, Field(gt=0, le=20, description="width of the nodal lines in pixels")] = 2.5,
    reference: Annotated[str, Field(description="figure of the dissertation that this one answers")] = "",
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")],
) -> Figure:
    """Some eigenfunctions in colour with their nodal lines, each in units of its root mean square."""
    known = [mode for mode in modes if mode < len(eigensolver.values)]
    if not known:
        raise ValueError(f"modes = {modes}: only 0..{len(eigensolver.values) - 1} were computed")
    scale = ColorScale(label="eigenfunction, units of its root mean square", colormap="RdBu_r", limits=(-2.0, 2.0))
    size = eigensolver.area**0.5
    views = []
    for mode in known:
        values = size * eigensolver.vectors[: len(surface.mesh.vertices), mode]
        mesh, level = surface.mesh, values
        lines: tuple[Contours, ...] = ()
        if not mesh.is_closed:
            mesh, rim, (values, level) = barycentric(mesh, values, without_rim(mesh, values))
            # half of the line along the rim lies outside
            lines = (Contours(rim, (1.0 - INSIDE,), QUIET, 2.0 * line_width),)
        if values.min() < 0 < values.max():
            lines = (*lines, Contours(level, (0.0,), INK, line_width))
        # modes are counted from the constant one, 0, which a fixed rim excludes
        number = mode + (eigensolver.boundary == "dirichlet")
        title = f"mode {number}, λ = {eigensolver.values[mode]:.4g}"
        views.append(SurfaceView(mesh, values, (azimuth, elevation), scale, lines, title))
    rows = [views[i : i + columns] for i in range(0, len(views), columns)]
    unit = f" (λ in 1/{surface.unit}²)" if surface.unit else ""
    against = compare(reference)
    caption = (
        f"Laplace-Beltrami eigenfunctions of {noun(surface.name)} with their nodal lines{unit}; "
        f"signs are arbitrary.{against}"
    )
    return replace(surface_panel(rows, width=width, caption=caption), title=surface.name)
