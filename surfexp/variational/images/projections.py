"""Projections of a surface onto a plane, in which pictures are painted."""

from __future__ import annotations

from typing import Literal

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface

Projection = Literal["planar", "cylindrical", "spherical", "coordinates"]
Vector = tuple[float, float, float]


def view_frame(front: Vector, up: Vector) -> Floats:
    """(3, 3) orthonormal rows right, up, front of a viewer who stands on the side `front` and looks back.

    Raises
    ------
    ValueError
        If the two directions are parallel or zero.
    """
    ahead, above = np.array(front, dtype=float), np.array(up, dtype=float)
    right = np.cross(above, ahead)
    if np.linalg.norm(right) <= 1e-9 * np.linalg.norm(above) * np.linalg.norm(ahead):
        raise ValueError(f"front = {front} and up = {up} have to be two different directions")
    right /= np.linalg.norm(right)
    above /= np.linalg.norm(above)
    return np.stack([right, above, np.cross(right, above)])


def project(
    surface: Surface,
    projection: Projection = "cylindrical",
    front: Vector = (-1.0, 0.0, 0.0),
    up: Vector = (0.0, 0.0, 1.0),
    centre: Vector | None = None,
    radius: float | None = None,
) -> Floats:
    """(n, 2) position of every vertex in the picture's plane: to the right and upward, seen from `front`.

    Parameters
    ----------
    surface : Surface
    projection : str
        "planar": along `front`. "cylindrical": about the axis `up`, arc length at `radius` and height, so that a
        cylinder of that radius is unrolled without distortion. "spherical": longitude and latitude times `radius`.
        "coordinates": the surface's own parameters.
    front, up : (3,)
        The side where the viewer stands and what is above there; only the part of `front` across `up` counts.
    centre : (3,), optional
        Point of the axis or centre of the sphere. Unless given, the origin where the surface lies around it, as
        generated surfaces do, else the middle of the bounding box; "planar" always takes the latter.
    radius : float, optional
        The median distance of the vertices from the axis or centre unless given.

    Raises
    ------
    ValueError
        If the projection is unknown or the surface has no coordinates where they are asked for.
    """
    if projection == "coordinates":
        if surface.coordinates is None:
            raise ValueError(f"surface {surface.name!r} has no coordinates; choose planar, cylindrical or spherical")
        return surface.coordinates[:, :2]
    points = surface.mesh.vertices
    lower, upper = points.min(axis=0), points.max(axis=0)
    middle = 0.5 * (lower + upper) if centre is None else np.array(centre, dtype=float)
    if centre is None and projection != "planar" and (lower < 0).all() and (upper > 0).all():
        # the middle of the box is off the axis as soon as a handle sticks out on one side
        middle = np.zeros(3)
    x, y, z = view_frame(front, up) @ (points - middle).T
    if projection == "planar":
        return np.stack([x, y], axis=1)
    angle, rho = np.arctan2(x, z), np.hypot(x, z)
    if projection == "cylindrical":
        return np.stack([angle * (radius or float(np.median(rho))), y], axis=1)
    if projection == "spherical":
        return np.stack([angle, np.arctan2(y, rho)], axis=1) * (radius or float(np.median(np.hypot(rho, y))))
    raise ValueError(f"projection {projection!r} is unknown, choose planar, cylindrical, spherical or coordinates")
