"""The picture of section 5.6: the parametrisation by level sets, and where two groups differ on it."""

import numpy as np
from pydantic import Field

from surfexp.drawings.patch_grid_drawing import grid_panel
from surfexp.figures.figure import Figure, sentence
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.skeletons.patch_grid import patch_grid


class LevelSetGrid(Options):
    """How it is drawn."""

    alpha: float = Field(0.0, ge=0, le=10, description="exponent of the flux weights, as in the statistic")
    ahead: tuple[float, float, float] = Field((1.0, 0.0, 0.0), description="direction in which u rises, on the whole")
    level: float = Field(0.05, gt=0, lt=1, description="level below which a corrected p is outlined")
    first: str = Field("first group", description="name of the first group")
    second: str = Field("second group", description="name of the second group")
    azimuth: float = Field(-90.0, ge=-360, le=360, description="direction of view about the vertical, degrees from x")
    elevation: float = Field(90.0, ge=-90, le=90, description="height of view, degrees; 90 looks down on x, y")
    width: int = Field(1500, ge=400, le=8000, description="pixels across")


@register("figure", "level_set_grid")
def level_set_grid_figure(options: LevelSetGrid, *, surface: Surface, statistic: Statistic) -> Figure:
    """The level-set grid on one patch with the test of a map upon it, and means and test unrolled over (u, v)."""
    columns = statistic.columns
    if not {"u", "v", "statistic", "corrected_p"} <= set(columns):
        raise ValueError(f"statistic {statistic.name!r} has no grid, take statistic level_set_parametrization")
    v = np.unique(columns["v"])
    shape = (len(columns["v"]) // len(v), len(v))
    grid = patch_grid(surface, shape[0], max(shape[1], 9), options.alpha, ahead=options.ahead)
    found = (columns["corrected_p"] <= options.level).reshape(shape)
    caption = (
        f"{sentence(statistic.name)} by level sets, u along the skeleton and v across: "
        f"{int(found.sum())} of {found.size} "
        f"points differ at level {options.level:g} after correction; the smallest p is {columns['corrected_p'].min():.3f}. "
        f"Red: larger in {options.first}. Drawn on {surface.name}."
    )
    return grid_panel(
        surface.mesh,
        grid,
        (columns["u"].reshape(shape)[:, 0], v),
        columns["statistic"].reshape(shape),
        found,
        (columns["first_mean"].reshape(shape), columns["second_mean"].reshape(shape)),
        names=(options.first, options.second),
        quantity=statistic.name.split(",")[0],
        view=(options.azimuth, options.elevation),
        width=options.width,
        caption=caption,
    )
