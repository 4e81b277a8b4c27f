"""Closed surfaces of any genus: tori in a row, joined smoothly."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.remeshing import Implicit
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.implicit_surface import mesh_implicit, smooth_union
from surfexp.mesh.surface import Surface

MAJOR, MINOR, DISTANCE = 1.0, 0.42, 2.3


def row_of_tori(genus: int) -> Implicit:
    """Implicit function, negative inside, of `genus` tori in the plane z = 0 along x, the row centred at the origin."""
    centres = DISTANCE * (np.arange(genus) - 0.5 * (genus - 1))

    def implicit(points: Floats) -> Floats:
        x, y, z = points.T
        tori = [np.hypot(np.hypot(x - centre, y) - MAJOR, z) - MINOR for centre in centres]
        union = tori[0]
        for torus in tori[1:]:
            union = smooth_union(union, torus, 0.3)
        return union

    return implicit


def genus_surface(genus: int = 2, count: int = 8000) -> Surface:
    """Closed surface of the given genus, at least 1, symmetric in x, y and z: `genus` = 2 is the double torus.

    Raises
    ------
    ValueError
        If the genus is under 1 or there are fewer than 1500 vertices for each handle.
    """
    if genus < 1 or count < 1500 * genus:
        raise ValueError(
            f"genus_surface has genus = {genus}, count = {count}; at least 1 and {1500 * max(genus, 1)} are needed"
        )
    half = 0.5 * DISTANCE * (genus - 1) + MAJOR + MINOR + 0.1
    mesh = mesh_implicit(row_of_tori(genus), [-half, -1.55, -0.55], [half, 1.55, 0.55], _spacing(genus, count), count)
    return with_metrics(
        Surface(mesh, name={1: "implicit torus", 2: "double torus"}.get(genus, f"genus-{genus} surface"))
    )


def half_double_torus(count: int = 31247) -> Surface:
    """Upper half of the double torus, cut by its plane z = 0 (figure 2.6): open, genus 0, three boundary loops.

    Raises
    ------
    ValueError
        If there are fewer than 1500 vertices.
    """
    if count < 1500:
        raise ValueError(f"half_double_torus has count = {count}; at least 1500 are needed")
    half = 0.5 * DISTANCE + MAJOR + MINOR + 0.1
    spacing = _spacing(1, count)
    mesh = mesh_implicit(row_of_tori(2), [-half, -1.55, 0.0], [half, 1.55, 0.55], spacing, count, open_floor=True)
    return with_metrics(Surface(mesh, name="half double torus"))


def _spacing(handles: int, count: int) -> float:
    return float(np.clip(4.4 * np.sqrt(handles / count), 0.03, 0.12))
