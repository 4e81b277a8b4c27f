"""The picture of figure 2.7: clean, noisy and denoised surface."""

from dataclasses import replace
from typing import Annotated

from pydantic import Field

from surfexp.figures.figure import Figure, compare, sentence
from surfexp.figures.panel import surface_panel
from surfexp.figures.render import SurfaceView
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.statistics.measurement import Measurement
from surfexp.variational.solution import Solution


@register("figure", "geometry")
def geometry_figure(
    clean: Surface,
    noisy: Surface,
    solver: Solution,
    measurement: Measurement,
    *,
    azimuth: Annotated[
        float, Field(ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    ] = -60.0,
    elevation: Annotated[float, Field(ge=-90, le=90, description="height of view, degrees")] = 25.0,
    reference: Annotated[str, Field(description="figure of the dissertation that this one answers")] = "",
    width: Annotated[int, Field(ge=200, le=8000, description="pixels across")] = 1500,
) -> Figure:
    """Clean, noisy and denoised surface side by side, lit alike (figure 2.7)."""
    view = (azimuth, elevation)
    meshes = {"clean": clean.mesh, "noisy": noisy.mesh, "denoised": TriangleMesh(solver.values, noisy.mesh.faces)}
    views = [SurfaceView(mesh, None, view, title=name) for name, mesh in meshes.items()]
    numbers, model = measurement.metrics, solver.model.replace("_", " ")
    if any("one by one" in note for note in solver.notes):
        model = f"{model}, coordinate by coordinate"
    caption = (
        f"{sentence(clean.name)} by {model}: normals off by "
        f"{numbers['normal_error_before']:.1f} degrees before, {numbers['normal_error']:.1f} after."
        f"{compare(reference)}"
    )
    return replace(surface_panel(views, width=width, caption=caption), title=f"{clean.name} · {model}")
