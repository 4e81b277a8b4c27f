"""Matte shading of a visible surface, in linear light."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.mesh.triangle_mesh import Floats

# directions to the lights in camera coordinates (right, up, toward the eye) and their strengths: key, fill
LIGHTS = (((-0.45, 0.62, 0.64), 0.62), ((0.75, -0.05, 0.66), 0.20))
SKY, GROUND = 0.34, 0.22
# how far light wraps around the terminator; clay is softer than Lambert's cosine
WRAP = 0.25
RIM_DARKENING = 0.35
CLAY = (0.86, 0.83, 0.79)
BACK_TINT = (0.55, 0.62, 0.72)
BACK_SHARE = 0.45


def to_linear(srgb: Floats) -> Floats:
    """Linear light of display colours in 0..1 (gamma 2.2)."""
    return np.clip(srgb, 0.0, 1.0) ** 2.2


def to_display(linear: Floats) -> NDArray[np.uint8]:
    """Display colours 0..255 of linear light."""
    return np.rint(255.0 * np.clip(linear, 0.0, 1.0) ** (1.0 / 2.2)).astype(np.uint8)


def illumination(normals: Floats) -> Floats:
    """(p,) light that a white matte surface returns, about 1 where it faces the key light.

    Parameters
    ----------
    normals : (p, 3) float64
        Unit normals toward the eye, in camera coordinates.
    """
    up = normals[:, 1]
    light = 0.5 * (SKY + GROUND) + 0.5 * (SKY - GROUND) * up
    for direction, strength in LIGHTS:
        cosine = normals @ (np.array(direction) / np.linalg.norm(direction))
        light += strength * np.maximum(cosine + WRAP, 0.0) / (1.0 + WRAP)
    # a soft dark edge where the surface turns away
    return light * (1.0 - RIM_DARKENING * (1.0 - np.clip(normals[:, 2], 0.0, 1.0)) ** 3)


def facing_normals(normals: Floats, back: NDArray[np.bool_]) -> Floats:
    """(p, 3) unit normals turned toward the eye where the back of a face is seen; (0, 0, 1) where there is none."""
    turned = np.where(back[:, None], -normals, normals)
    lengths = np.linalg.norm(turned, axis=1, keepdims=True)
    return np.where(lengths > 0.0, turned / np.where(lengths > 0.0, lengths, 1.0), [0.0, 0.0, 1.0])


def shade(base: Floats, normals: Floats, back: NDArray[np.bool_], strength: float = 1.0) -> Floats:
    """(p, 3) linear light of a matte surface.

    Parameters
    ----------
    base : (p, 3) float64
        Linear colours of the surface.
    normals : (p, 3) float64
        As in `illumination`.
    back : (p,) bool
        Where the back of a face is seen; it is tinted blue.
    strength : float
        0 leaves the colours as they are, 1 is full light and shade.
    """
    tint = (1.0 - BACK_SHARE) * base + BACK_SHARE * to_linear(np.array(BACK_TINT))
    light = 1.0 + strength * (illumination(normals) - 1.0)
    return np.where(back[:, None], tint, base) * light[:, None]
