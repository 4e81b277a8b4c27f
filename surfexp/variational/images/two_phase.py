"""Images of two levels whose boundary is known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image


def two_phase(
    surface: Surface, level: Floats, inside: float = 255.0, outside: float = 0.0, boundary_length: float | None = None
) -> Image:
    """The image that is `inside` where a level function is negative and `outside` elsewhere.

    Parameters
    ----------
    surface : Surface
    level : (n,)
        Values of a function at the vertices: `coordinates[:, 0] - 1.0` is a cap of one radian on a spherical cap.
    boundary_length : float, optional
        Exact length of the zero line, kept in the metrics.

    Returns
    -------
    Image
        With the label "inside".

    Raises
    ------
    ValueError
        If the level function has another length than the surface, is not finite or leaves one phase empty.
    """
    level = np.asarray(level, dtype=float)
    if level.shape != (len(surface.mesh.vertices),):
        raise ValueError(f"level has shape {level.shape}, the surface has {len(surface.mesh.vertices)} vertices")
    within: NDArray[np.bool_] = level < 0
    if not np.isfinite(level).all() or within.all() or not within.any():
        raise ValueError(f"level is negative at {within.sum()} of {len(level)} vertices; both phases have to be there")
    metrics = {} if boundary_length is None else {"boundary_length": boundary_length}
    values = np.where(within, inside, outside)
    return Image(values, name="two-phase image", labels={"inside": within}, metrics=metrics)


def coloured_cells(surface: Surface, cells: int = 24, seed: int = 0) -> Image:
    """A coloured texture: the cells of seeded vertices in space, each of one random colour 0..255, (n, 3), and labels.

    Raises
    ------
    ValueError
        If there are more cells than vertices, or none.
    """
    vertices = surface.mesh.vertices
    if not 1 <= cells <= len(vertices):
        raise ValueError(f"coloured_cells has cells = {cells}; 1..{len(vertices)} are possible on this surface")
    random = np.random.default_rng(seed)
    seeds = vertices[random.choice(len(vertices), cells, replace=False)]
    nearest = np.linalg.norm(vertices[:, None, :] - seeds[None, :, :], axis=2).argmin(axis=1)
    labels = {f"cell {cell + 1}": nearest == cell for cell in range(cells)}
    return Image(random.uniform(0.0, 255.0, (cells, 3))[nearest], name="coloured cells", labels=labels)
