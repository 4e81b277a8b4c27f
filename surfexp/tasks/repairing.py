"""The defects of surfaces that are given as arrays, and surfaces without them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import Report, validate
from surfexp.tasks.given_surface import SurfaceLike, arrays_of
from surfexp.tasks.repaired_surface import repaired
from surfexp.tasks.stored_surface import stored_surface


def check(surface: SurfaceLike) -> Report:
    """Find every defect of a surface.

    Parameters
    ----------
    surface : Surface, TriangleMesh, (vertices, faces), or a path
        Defects are allowed.

    Returns
    -------
    Report
        `ok` says whether every method can use the surface; `lines()` names each defect; `count(kind)` counts one kind.

    Raises
    ------
    ValueError
        If the input is not a surface, or a file cannot be read.

    Examples
    --------
    >>> import surfexp as sx
    >>> ball = sx.shape("icosphere", levels=2).mesh
    >>> sx.check((ball.vertices, ball.faces[:, ::-1])).lines()
    ['repairable: 320 faces of inside-out closed components (face 0, face 1, face 2, ...)']
    """
    surface = stored_surface(surface) if isinstance(surface, str | Path) else surface
    vertices, faces = arrays_of(surface)
    if isinstance(surface, Surface) and surface.right is not None:
        # hemispheres may overlap in space, as inflated ones do: they are judged beside one another
        beside = 4.0 * np.abs(vertices[np.isfinite(vertices)]).max(initial=0.0)
        vertices = vertices + np.where(surface.right, beside, 0.0)[:, None] * np.array([1.0, 0.0, 0.0])
    return validate(vertices, faces)


def repair(surface: SurfaceLike, *, largest_component: bool = False, renumber: bool = False) -> Surface:
    """Repair the defects of a surface; its maps, labels and mask follow, and its vertices keep their numbers.

    Parameters
    ----------
    surface : Surface, TriangleMesh, (vertices, faces), or a path
        Of a file all that `read` finds in it: maps, labels, mask, unit, both hemispheres.
    largest_component : bool
        Keep only the component of largest area, of both hemispheres that of each.
    renumber : bool
        Drop vertices that have no face, so that others get their numbers. Without it they stay, and count as outside.

    Returns
    -------
    Surface
        `notes` name each change. Where vertices were split, the copies stand behind all others.

    Raises
    ------
    ValueError
        If a defect cannot be repaired, or nothing would be left.

    Examples
    --------
    >>> import surfexp as sx
    >>> ball = sx.shape("icosphere", levels=2).mesh
    >>> outward = sx.repair((ball.vertices, ball.faces[:, ::-1]))
    >>> sx.check(outward).ok, len(outward.notes)
    (True, 1)
    """
    surface = stored_surface(surface) if isinstance(surface, str | Path) else surface
    owner = surface if isinstance(surface, Surface) else Surface(TriangleMesh(*arrays_of(surface)))
    return repaired(owner, largest_component, renumber)
