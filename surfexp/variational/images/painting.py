"""Pictures painted onto surfaces, and noise."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.projections import Projection, Vector, project

Extension = Literal["reflect", "wrap", "edge"]
MODES = {"reflect": "reflect", "wrap": "grid-wrap", "edge": "nearest"}


def paint(
    surface: Surface,
    picture: Floats,
    projection: Projection = "cylindrical",
    *,
    front: Vector = (-1.0, 0.0, 0.0),
    up: Vector = (0.0, 0.0, 1.0),
    centre: Vector | None = None,
    radius: float | None = None,
    width: float | None = None,
    height: float | None = None,
    extension: Extension = "reflect",
    name: str = "picture",
) -> Image:
    """Sample a picture bilinearly at the vertices, seen upright and unmirrored from the side `front`.

    The picture is first smoothed to the resolution of the mesh (Gaussian, 0.4 edge lengths), without which its finest
    detail would reach the vertices as noise.

    Parameters
    ----------
    surface : Surface
    picture : (h, w) or (h, w, c) float64
        Row 0 on top.
    projection, front, up, centre, radius
        See `surfexp.variational.projections.project`. "planar" paints the far side too, mirrored.
    width, height : float, optional
        Size of the picture in the plane of the projection, about its origin (planar, cylindrical, spherical) or the
        middle of the coordinates. One gives the other by the picture's proportions; without both, the picture is as high
        as the surface (cylindrical, spherical) or just covers it (planar, coordinates).
    extension : "reflect", "wrap" or "edge"
        What lies beyond the picture: its mirror image, itself again, or its outermost pixels.

    Raises
    ------
    ValueError
        If the picture is not finite, smaller than 2 x 2, or has no proper shape; if a size is not positive.
    """
    picture = np.asarray(picture, dtype=float)
    if picture.ndim not in (2, 3) or min(picture.shape[:2]) < 2 or not np.isfinite(picture).all():
        raise ValueError(
            f"picture has shape {picture.shape}; finite values, (h, w) or (h, w, c) from 2 x 2, are needed"
        )
    if extension not in MODES:
        raise ValueError(f"extension {extension!r} is unknown, choose one of {', '.join(MODES)}")
    plane = project(surface, projection, front, up, centre, radius)
    lower, upper = plane.min(axis=0), plane.max(axis=0)
    middle = 0.5 * (lower + upper) if projection == "coordinates" else np.zeros(2)
    extent = 2.0 * np.maximum(upper - middle, middle - lower)
    if projection in ("cylindrical", "spherical") and width is None and height is None:
        height = float(extent[1])
    width, height = _size(extent, picture.shape, width, height)
    rows, columns = picture.shape[:2]
    row = (0.5 - (plane[:, 1] - middle[1]) / height) * rows - 0.5
    column = (0.5 + (plane[:, 0] - middle[0]) / width) * columns - 0.5
    # coordinates have a scale of their own, which says nothing about the distance of vertices
    edge = 0.0 if projection == "coordinates" else surface.mesh.edge_length
    blur = (0.4 * edge * rows / height, 0.4 * edge * columns / width)
    note = f"painted by {projection} projection, {width:.4g} x {height:.4g} {surface.unit}".rstrip()
    return Image(_sampled(picture, row, column, blur, MODES[extension]), name=name, notes=(note,))


def _sampled(picture: Floats, row: Floats, column: Floats, blur: tuple[float, float], mode: str) -> Floats:
    """Return (n,) or (n, c) values of a smoothed picture between its pixels, `blur` in rows and columns."""
    channels = picture[:, :, None] if picture.ndim == 2 else picture
    smoothing = mode.removeprefix("grid-")
    values = [
        map_coordinates(gaussian_filter(channel, blur, mode=smoothing), (row, column), order=1, mode=mode)
        for channel in np.moveaxis(channels, 2, 0)
    ]
    stacked = np.stack(values, axis=1)
    return stacked[:, 0] if picture.ndim == 2 else stacked


def _size(extent: Floats, shape: tuple[int, ...], width: float | None, height: float | None) -> tuple[float, float]:
    rows, columns = shape[:2]
    if width is None:
        width = max(float(extent[0]), float(extent[1]) * columns / rows) if height is None else height * columns / rows
    height = width * rows / columns if height is None else height
    if min(width, height) <= 0:
        raise ValueError(f"picture has size {width} x {height}; both have to be positive")
    return width, height


def add_noise(image: Image, sigma: float, seed: int = 0) -> Image:
    """The image with seeded Gaussian noise of standard deviation `sigma` (0..255 scale) at every value.

    `clean` of the result is the image as it was, or its own clean version where it has one.

    Raises
    ------
    ValueError
        If sigma is negative.
    """
    if not sigma >= 0:
        raise ValueError(f"noise has sigma = {sigma}; it cannot be negative")
    noisy = image.values + np.random.default_rng(seed).normal(0.0, sigma, image.values.shape)
    clean = image.values if image.clean is None else image.clean
    return replace(image, values=noisy, clean=clean, noise=float(np.hypot(image.noise, sigma)))
