"""The picture of section 5.6: the parametrisation by level sets, and where two groups differ on it."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.drawings.patch_grid_drawing import grid_panel
from surfexp.figures.figure import Figure, sentence
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.patch_grid import patch_grid


@register("figure", "level_set_grid", defaults_of=(patch_grid, grid_panel))
def level_set_grid_figure(
    surface: Surface,
    statistic: Statistic,
    *,
    alpha: Annotated[float, Field(ge=0, le=10, description="exponent of the flux weights, as in the statistic")],
    ahead: Annotated[tuple[float, float, float], Field(description="direction in which u rises, on the whole")],
    level: Annotated[float, Field(gt=0, lt=1, description="level below which a corrected p is outlined")] = 0.05,
    first: Annotated[str, Field(description="name of the first group")] = "first group",
    second: Annotated[str, Field(description="name of the second group")] = "second group",
    azimuth: Annotated[
        float, Field(ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    ] = -90.0,
    elevation: Annotated[
        float, Field(ge=-90, le=90, description="height of view, degrees; 90 looks down on x, y")
    ] = 90.0,
    width: Annotated[int, Field(ge=400, le=8000, description="pixels across")],
) -> Figure:
    """The level-set grid on one patch with the test of a map upon it, and means and test unrolled over (u, v)."""
    columns = statistic.columns
    if not {"u", "v", "statistic", "corrected_p"} <= set(columns):
        raise ValueError(f"statistic {statistic.name!r} has no grid, take statistic level_set_parametrization")
    v = np.unique(columns["v"])
    shape = (len(columns["v"]) // len(v), len(v))
    grid = patch_grid(surface, shape[0], max(shape[1], 9), alpha, ahead=ahead)
    found = (columns["corrected_p"] <= level).reshape(shape)
    caption = (
        f"{sentence(statistic.name)} by level sets, u along the skeleton and v across: "
        f"{int(found.sum())} of {found.size} "
        f"points differ at level {level:g} after correction; the smallest p is {columns['corrected_p'].min():.3f}. "
        f"Red: larger in {first}. Drawn on {surface.name}."
    )
    return grid_panel(
        surface.mesh,
        grid,
        (columns["u"].reshape(shape)[:, 0], v),
        columns["statistic"].reshape(shape),
        found,
        (columns["first_mean"].reshape(shape), columns["second_mean"].reshape(shape)),
        names=(first, second),
        quantity=statistic.name.split(",")[0],
        view=(azimuth, elevation),
        width=width,
        caption=caption,
    )
