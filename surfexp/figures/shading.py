"""Matte shading of the visible surface, in linear light."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.figures.camera import Camera
from surfexp.figures.rasterizer import Raster
from surfexp.mesh.triangle_mesh import TriangleMesh

# unit directions to the lights in camera coordinates (right, up, toward the eye) and their strengths
KEY, KEY_STRENGTH = (-0.450, 0.620, 0.643), 0.66
FILL, FILL_STRENGTH = (0.750, -0.050, 0.660), 0.20
SKY, GROUND = 0.34, 0.22
# how far light wraps around the terminator; clay is softer than Lambert's cosine
WRAP = 0.25
RIM_DARKENING = 0.35
BACK_TINT, BACK_SHARE = (0.26, 0.34, 0.48), 0.45
GAMMA = 2.2
# the least light that is shown as 1 to 255, and what is shown at least of light in equal steps: a power costs ten times more
LEAST_LIGHT = ((np.arange(1.0, 256.0) - 0.5) / 255.0) ** GAMMA
GUESSES = np.searchsorted(LEAST_LIGHT, np.arange(4096.0) / 4096.0, side="right")


@dataclass(frozen=True, eq=False)
class Shaded:
    """What falls on each pixel of a picture.

    Parameters
    ----------
    light : (height, width, 3) float64
        Linear colour, weighted with the coverage.
    coverage : (height, width) float64
        Share of the pixel where the surface is seen.
    normals : (height, width, 3) float64
        Unit mean normals toward the eye in camera coordinates, zero where nothing is seen.
    """

    light: Floats
    coverage: Floats
    normals: Floats


def to_linear(srgb: Floats) -> Floats:
    """Linear light of display colours in 0..1 (gamma 2.2); NaN stays."""
    return np.clip(srgb, 0.0, 1.0) ** GAMMA


def to_display(linear: Floats) -> NDArray[np.uint8]:
    """Display colours 0..255 of linear light."""
    return _displayed(np.ascontiguousarray(linear).reshape(-1), LEAST_LIGHT, GUESSES).reshape(linear.shape)


def seen_from_behind(mesh: TriangleMesh, camera: Camera) -> NDArray[np.bool_]:
    """(m,) whether the eye is on the inner side of each face."""
    toward = camera.axes[2]
    if np.isinf(camera.distance):
        return mesh.face_normals @ toward < 0.0
    to_eye = camera.center + camera.distance * toward - mesh.vertices[mesh.faces[:, 0]]
    return (mesh.face_normals * to_eye).sum(axis=1) < 0.0


def shade(
    mesh: TriangleMesh,
    camera: Camera,
    raster: Raster,
    coloring: Floats,
    table: Floats,
    strength: float,
    factor: int,
    flat: bool = False,
) -> Shaded:
    """Light from a surface with interpolated normals under a key light, a fill light and the sky.

    Parameters
    ----------
    raster : Raster
        Of factor x factor samples for each pixel.
    coloring : (n, 1) or (n, 3) float64
        At the vertices: a position in the table in 0..1, or a linear colour.
    table : (k + 1, 3) float64
        Linear colours for positions from 0 to 1, then the colour of NaN.
    strength : float
        0 leaves the colours as they are, 1 is full light and shade.
    factor : int
    flat : bool
        Whether a point takes the colour of the corner nearest to it, as labels do, and not the mean of the three.
    """
    height, width = raster.face.shape[0] // factor, raster.face.shape[1] // factor
    light, normals = np.zeros((height, width, 3)), np.zeros((height, width, 3))
    coverage = np.zeros((height, width))
    turn = np.where(seen_from_behind(mesh, camera), -1.0, 1.0)
    vertex_normals = mesh.vertex_normals @ camera.axes.T
    _shade(
        raster.face, raster.barycentric, mesh.faces, vertex_normals, turn, coloring, table, strength, factor, flat,
        light, normals, coverage,
    )  # fmt: skip
    lengths = np.sqrt(np.einsum("ijk,ijk->ij", normals, normals))[:, :, None]
    return Shaded(light, coverage, normals / np.where(lengths > 0.0, lengths, 1.0))


@njit(cache=True, nogil=True, error_model="numpy")
def illumination(x: float, y: float, z: float) -> float:
    """Light that a white matte surface with unit normal (x, y, z) in camera coordinates returns, about 1 toward the key."""
    key = KEY[0] * x + KEY[1] * y + KEY[2] * z
    fill = FILL[0] * x + FILL[1] * y + FILL[2] * z
    light = 0.5 * (SKY + GROUND) + 0.5 * (SKY - GROUND) * y
    light += (KEY_STRENGTH * max(key + WRAP, 0.0) + FILL_STRENGTH * max(fill + WRAP, 0.0)) / (1.0 + WRAP)
    # a soft dark edge where the surface turns away
    return light * (1.0 - RIM_DARKENING * (1.0 - min(max(z, 0.0), 1.0)) ** 3)


@njit(cache=True, nogil=True, error_model="numpy")
def _shade(
    face: Integers, barycentric: Floats, faces: Integers, vertex_normals: Floats, turn: Floats, coloring: Floats,
    table: Floats, strength: float, factor: int, flat: bool, light: Floats, normals: Floats, coverage: Floats,
) -> None:  # fmt: skip
    share = 1.0 / factor**2
    last = len(table) - 2
    by_table = coloring.shape[1] == 1
    for row in range(face.shape[0]):
        for column in range(face.shape[1]):
            t = face[row, column]
            if t < 0:
                continue
            i, j = row // factor, column // factor
            red = green = blue = x = y = z = 0.0
            nearest = np.argmax(barycentric[row, column]) if flat else -1
            for k in range(3):
                weight, vertex = barycentric[row, column, k], faces[t, k]
                x += weight * vertex_normals[vertex, 0]
                y += weight * vertex_normals[vertex, 1]
                z += weight * vertex_normals[vertex, 2]
                if flat:
                    weight = 1.0 if k == nearest else 0.0
                    # a corner that counts nothing may have no value
                    if weight == 0.0:
                        continue
                red += weight * coloring[vertex, 0]
                if not by_table:
                    green += weight * coloring[vertex, 1]
                    blue += weight * coloring[vertex, 2]
            length = turn[t] * np.sqrt(x * x + y * y + z * z)
            # opposite normals cancel at a needle; it is lit from the front
            x, y, z = (x / length, y / length, z / length) if length != 0.0 else (0.0, 0.0, 1.0)
            missing = np.isnan(red + green + blue)
            if missing or by_table:
                place = last + 1 if missing else int(min(max(red * (last + 1), 0.0), float(last)))
                red, green, blue = table[place, 0], table[place, 1], table[place, 2]
            received = share * (1.0 + strength * (illumination(x, y, z) - 1.0))
            tint = BACK_SHARE if turn[t] < 0.0 else 0.0
            light[i, j, 0] += received * ((1.0 - tint) * red + tint * BACK_TINT[0])
            light[i, j, 1] += received * ((1.0 - tint) * green + tint * BACK_TINT[1])
            light[i, j, 2] += received * ((1.0 - tint) * blue + tint * BACK_TINT[2])
            normals[i, j, 0] += x
            normals[i, j, 1] += y
            normals[i, j, 2] += z
            coverage[i, j] += share


@njit(cache=True, nogil=True)
def _displayed(linear: Floats, least_light: Floats, guesses: Integers) -> NDArray[np.uint8]:
    """The nearest of 0..255 to 255 x^(1 / 2.2): looked up, then raised while there is light enough for more."""
    shown = np.full(len(linear), 255, dtype=np.uint8)
    for p in range(len(linear)):
        light = linear[p]
        if light < 1.0:
            level = guesses[int(max(light, 0.0) * len(guesses))]
            while level < 255 and least_light[level] <= light:
                level += 1
            shown[p] = level
    return shown
