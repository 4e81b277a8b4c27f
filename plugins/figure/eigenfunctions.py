"""Eigenfunctions and their nodal lines, figures 3.1, 4.3 and 4.4."""

from dataclasses import replace

from pydantic import Field

from surfexp.figures.boundary_line import INSIDE, barycentric, without_rim
from surfexp.figures.colormap import ColorScale
from surfexp.figures.contours import Contours
from surfexp.figures.figure import Figure, compare, noun
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.figures.typography import INK, QUIET
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem


class Eigenfunctions(Options):
    """Which modes are drawn, from where."""

    modes: list[int] = Field([1, 2, 3, 4, 5, 10, 20, 40], description="which modes, counted from 0")
    azimuth: float = Field(-60.0, ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    elevation: float = Field(20.0, ge=-90, le=90, description="height of view, degrees")
    columns: int = Field(4, ge=1, le=12, description="pictures in a row")
    line_width: float = Field(2.5, gt=0, le=20, description="width of the nodal lines in pixels")
    reference: str = Field("", description="figure of the dissertation that this one answers")
    width: int = Field(1600, ge=200, le=8000, description="pixels across")


@register("figure", "eigenfunctions")
def eigenfunctions_figure(options: Eigenfunctions, *, surface: Surface, eigensolver: EigenSystem) -> Figure:
    """Some eigenfunctions in colour with their nodal lines, each in units of its root mean square."""
    known = [mode for mode in options.modes if mode < len(eigensolver.values)]
    if not known:
        raise ValueError(f"modes = {options.modes}: only 0..{len(eigensolver.values) - 1} were computed")
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
            lines = (Contours(rim, (1.0 - INSIDE,), QUIET, 2.0 * options.line_width),)
        if values.min() < 0 < values.max():
            lines = (*lines, Contours(level, (0.0,), INK, options.line_width))
        # modes are counted from the constant one, 0, which a fixed rim excludes
        number = mode + (eigensolver.boundary == "dirichlet")
        title = f"mode {number}, λ = {eigensolver.values[mode]:.4g}"
        views.append(SurfaceView(mesh, values, (options.azimuth, options.elevation), scale, lines, title))
    rows = [views[i : i + options.columns] for i in range(0, len(views), options.columns)]
    unit = f" (λ in 1/{surface.unit}²)" if surface.unit else ""
    against = compare(options.reference)
    caption = (
        f"Laplace-Beltrami eigenfunctions of {noun(surface.name)} with their nodal lines{unit}; "
        f"signs are arbitrary.{against}"
    )
    return replace(surface_panel(rows, width=options.width, caption=caption), title=surface.name)
