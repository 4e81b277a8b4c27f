"""Synthetic corpora callosa: a curved midline that is known, a width along it, and the staircase edge of a manual mask."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.planar_patch import triangulate_region
from surfexp.mesh.surface import Surface, Truth
from surfexp.studies.callosum.planted_map import planted_map

# share of the midline, turning angle in degrees from the x axis (forward), half width in mm: splenium, isthmus, body, genu, rostrum
SHARES = np.array([0.0, 0.10, 0.22, 0.34, 0.50, 0.64, 0.74, 0.82, 0.91, 1.0])
ANGLES = np.array([78.0, 52.0, 30.0, 14.0, -4.0, -24.0, -70.0, -135.0, -172.0, -182.0])
HALF_WIDTHS = np.array([4.6, 4.4, 2.6, 2.2, 2.9, 3.3, 4.4, 4.2, 2.3, 1.3])
LENGTH = 92.0
ISTHMUS, ISTHMUS_SPREAD = 0.31, 0.06
GENU = (0.64, 0.91)


@dataclass(frozen=True, eq=False)
class Callosum:
    """The shape behind a patch.

    Parameters
    ----------
    midline : (s, 2) float64
        In mm, evenly spaced, from the centre of the last disc at the splenium to that at the rostrum.
    half_width : (s,) float64
        Radii of the discs whose union the shape is, so that the midline is its medial axis.
    """

    midline: Floats
    half_width: Floats


def callosum_shape(seed: int = 0, thinning: float = 0.0, samples: int = 801) -> Callosum:
    """One random callosum.

    Length varies by 8 %, every half width by 10 % and every turning angle by 6 degrees (standard deviations, cut off at two).

    Parameters
    ----------
    seed : int
    thinning : float
        Share by which the isthmus is thinned, at 31 % of the midline, Gaussian along it with a deviation of 6 %.

    Raises
    ------
    ValueError
        If the thinning is not in 0..0.8.
    """
    if not 0.0 <= thinning <= 0.8:
        raise ValueError(f"thinning is {thinning}, it must lie in 0..0.8")
    from scipy.interpolate import PchipInterpolator

    rng = np.random.default_rng(seed)

    def varied(count: int) -> Floats:
        return np.clip(rng.normal(size=count), -2.0, 2.0)

    length = LENGTH * (1.0 + 0.08 * varied(1)[0])
    angles = np.radians(ANGLES + 6.0 * varied(len(ANGLES)))
    widths = HALF_WIDTHS * (1.0 + 0.10 * varied(len(HALF_WIDTHS)))
    share = np.linspace(0.0, 1.0, samples)
    angle = PchipInterpolator(SHARES, angles)(share)
    bump = np.exp(-0.5 * ((share - ISTHMUS) / ISTHMUS_SPREAD) ** 2)
    half_width = PchipInterpolator(SHARES, widths)(share) * (1.0 - thinning * bump)
    step = length / (samples - 1)
    path = [np.concatenate([[0.0], np.cumsum(0.5 * (f[1:] + f[:-1])) * step]) for f in (np.cos(angle), np.sin(angle))]
    return Callosum(np.stack(path, axis=1), half_width)


def callosum(
    seed: int = 0,
    thinning: float = 0.0,
    edge_length: float = 0.6,
    pixel: float = 0.7,
    turn: float = 0.0,
    signal: float | None = None,
) -> Surface:
    """A flat patch of about 2,000 vertices with the staircase edge of a mask; x is forward, y up, in mm.

    Parameters
    ----------
    seed, thinning
        As in `callosum_shape`; they are repeated in the metrics.
    edge_length, pixel : float
        Of the triangles, and of the mask, in mm.
    turn : float
        Degrees by which the mask's grid is turned against the shape, for another staircase.
    signal : float, optional
        Height of the bump in a synthetic map, which becomes the scalar map "signal", as in `planted_map`.

    Raises
    ------
    ValueError
        If the pixels are too large for the rostrum.
    """
    if not 0 < pixel <= 1.5 or not 0.05 <= edge_length <= 2.0:
        raise ValueError(f"pixel = {pixel} and edge_length = {edge_length}; take 0 < pixel <= 1.5 and 0.05..2")
    shape = callosum_shape(seed, thinning)
    angle = np.radians(turn)
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    midline = shape.midline @ rotation.T

    def inside(points: Floats) -> Floats:
        from scipy.spatial import cKDTree

        found = np.zeros(len(points), dtype=bool)
        tree = cKDTree(points)
        for centre, radius in zip(midline[::2], shape.half_width[::2], strict=True):
            found[tree.query_ball_point(centre, radius)] = True
        return found

    reach = 1.1 * shape.half_width.max()
    mesh = triangulate_region(inside, midline.min(axis=0) - reach, midline.max(axis=0) + reach, pixel, edge_length)
    back = np.eye(3)
    back[:2, :2] = rotation
    mesh = type(mesh)(mesh.vertices @ back, mesh.faces)
    known = {"seed": float(seed), "thinning": thinning}
    scalars = {}
    if signal is not None:
        scalars["signal"] = planted_map(mesh.vertices[:, :2], shape, signal, seed)
    flat = mesh.vertices[:, :2]
    line = np.concatenate([shape.midline, np.zeros((len(shape.midline), 1))], axis=1)
    truth = Truth(midline=line)
    return with_metrics(Surface(mesh, f"callosum {seed}", "mm", scalars, coordinates=flat, metrics=known, truth=truth))
