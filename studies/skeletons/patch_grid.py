"""Patches of a group on one grid, u along the skeleton and v across it, and maps compared point by point (section 5.6)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.skeleton.boundary_distance import boundary_distance
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.parametrization import LevelSetParametrization, level_set_parametrization

from .positionwise_comparison import PointwiseTest, pointwise_test
from .skeleton_study import signed_eigenmap

Direction = tuple[float, float, float]
WIDTH, DISTANCE = "width", "boundary_distance"


@dataclass(frozen=True, eq=False)
class GridComparison:
    """Means of two groups on the grid, and where they differ.

    Parameters
    ----------
    u, v : (K,), (M,) float64
        One v, in the middle, for the width.
    first, second : (s, K, M) float64
        The map of every member.
    test : PointwiseTest
        Of K M positions, by rows of one u, corrected for all of them together.
    left_out : int
        Contours around teeth of the edges, over all members.
    """

    u: Floats
    v: Floats
    first: Floats
    second: Floats
    test: PointwiseTest
    left_out: int


def patch_grid(
    surface: Surface,
    along: int = 40,
    across: int = 15,
    alpha: float = 0.0,
    chosen: str = WIDTH,
    ahead: Direction = (1.0, 0.0, 0.0),
    persistence: float = 0.01,
) -> LevelSetParametrization:
    """The grid of one patch, by its eigenmap at levels of equal distances, and one map on it.

    Parameters
    ----------
    along, across : int
        Numbers of contours, and of points on each.
    alpha : float
        Exponent of the flux weights (5.10); the weight is 1 at 0.
    chosen : str
        "width", "boundary_distance", or the name of a scalar map of the surface.
    ahead : (3,) float
        Direction in which u rises, on the whole.
    persistence : float
        As in `level_set_parametrization`.

    Raises
    ------
    ValueError
        If the surface has no such map, or the levels are not single lines.
    """
    mesh = surface.mesh
    if chosen == DISTANCE:
        maps = {chosen: boundary_distance(mesh)}
    elif chosen == WIDTH:
        maps = {}
    elif chosen in surface.scalars:
        maps = {chosen: surface.scalars[chosen]}
    else:
        known = ", ".join([WIDTH, DISTANCE, *surface.scalars])
        raise ValueError(f"surface {surface.name!r} has no map {chosen!r}, choose one of {known}")
    values = signed_eigenmap(mesh, alpha, ahead=np.array(ahead))
    return level_set_parametrization(
        mesh, values, choose_levels(mesh, values, along, "arc_length"), across, maps, persistence
    )


def map_on(grid: LevelSetParametrization, chosen: str) -> Floats:
    """(K, M) a map on the grid; the width is the same all across."""
    return np.repeat(grid.width[:, None], len(grid.v), axis=1) if chosen == WIDTH else grid.maps[chosen]


def compare_on_grid(
    first: Mapping[str, Surface],
    second: Mapping[str, Surface],
    along: int = 40,
    across: int = 15,
    alpha: float = 0.0,
    *,
    chosen: str,
    ahead: Direction = (1.0, 0.0, 0.0),
    permutations: int = 1000,
    seed: int = 0,
) -> GridComparison:
    """Compare two groups of patches at every point of the grid; places are means over all members.

    Raises
    ------
    ValueError
        As `patch_grid` and `pointwise_test`.
    """
    groups = [
        [patch_grid(surface, along, across, alpha, chosen, ahead) for surface in group.values()]
        for group in (first, second)
    ]
    maps = [np.stack([map_on(grid, chosen) for grid in group]) for group in groups]
    # the width has one number for each u
    columns = slice(0, 1) if chosen == WIDTH else slice(None)
    one, other = (values[:, :, columns].reshape(len(values), -1) for values in maps)
    test = pointwise_test(one, other, permutations=permutations, seed=seed)
    everyone = [*groups[0], *groups[1]]
    u, v = np.mean([grid.u for grid in everyone], axis=0), everyone[0].v
    if chosen == WIDTH:
        maps, v = [values[:, :, :1] for values in maps], np.array([0.5])
    return GridComparison(u, v, maps[0], maps[1], test, sum(grid.left_out for grid in everyone))


def region_found(comparison: GridComparison, level: float = 0.05) -> dict[str, float]:
    """Where the test finds a difference after correction: number and share of the points, and centre and extent in u and v.

    The centre is the mean of the places found, weighted by |t|; it is that of the largest |t| where nothing is found.
    """
    shape = (len(comparison.u), len(comparison.v))
    strength = np.abs(comparison.test.statistic).reshape(shape)
    found = (comparison.test.corrected <= level).reshape(shape)
    chosen = found if found.any() else strength == strength.max()
    weights = np.where(chosen, np.maximum(strength, 1e-12), 0.0)
    weights /= weights.sum()
    rows, columns = np.nonzero(chosen)
    numbers = {
        "points": found.size,
        "points_found": found.sum(),
        "share_found": found.mean(),
        "points_uncorrected": (comparison.test.uncorrected <= level).sum(),
        "smallest_corrected_p": comparison.test.corrected.min(),
        "centre_u": weights.sum(axis=1) @ comparison.u,
        "centre_v": weights.sum(axis=0) @ comparison.v,
        "from_u": comparison.u[rows.min()],
        "to_u": comparison.u[rows.max()],
        "from_v": comparison.v[columns.min()],
        "to_v": comparison.v[columns.max()],
    }
    return {name: float(number) for name, number in numbers.items()}
