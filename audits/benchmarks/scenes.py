"""The surfaces and images that lines share, made once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from surfexp.mesh.shapes.cortex import cortex
from surfexp.mesh.shapes.cup import cup
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise, paint
from surfexp.variational.images.pictures import picture


@dataclass(frozen=True, eq=False)
class Scene:
    """A surface and an image on it."""

    surface: Surface
    image: Image


@cache
def cup_scene(count: int) -> Scene:
    """The cameraman on the cup with noise of 40 of 0..255 (figure 2.2)."""
    surface = cup(count)
    image = paint(surface, picture("cameraman"), front=(0.0, -1.0, 0.0), width=2.5)
    return Scene(surface, add_noise(image, 40.0))


@cache
def torus_scene(side: int) -> Scene:
    """The cameraman on a torus of side x side vertices with noise of 40 (figure 2.4)."""
    surface = torus(side, side)
    image = paint(surface, picture("cameraman"), "planar", front=(0.0, 0.0, 1.0), up=(0.0, 1.0, 0.0))
    return Scene(surface, add_noise(image, 40.0))


@cache
def cortex_scene(count: int) -> Scene:
    """Letters on the folded cortex M2 with noise of 40 (table 2.2)."""
    surface = cortex("folded", count)
    image = paint(surface, picture("letters"), "spherical", front=(0.0, -1.0, 0.0))
    return Scene(surface, add_noise(image, 40.0))
