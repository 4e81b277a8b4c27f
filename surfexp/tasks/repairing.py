"""The defects of surfaces that are given as arrays, and surfaces without them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from surfexp.io.reading import read_mesh
from surfexp.mesh.repair import repair as repaired_mesh
from surfexp.mesh.surface import Surface, Truth
from surfexp.mesh.validate import Report, validate
from surfexp.tasks.inputs import SurfaceLike, arrays_of


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
    return validate(*(read_mesh(surface)[:2] if isinstance(surface, str | Path) else arrays_of(surface)))


def repair(surface: SurfaceLike, *, largest_component: bool = False) -> Surface:
    """Repair the defects of a surface; its maps, labels and mask follow.

    Parameters
    ----------
    surface : Surface, TriangleMesh, (vertices, faces), or a path
    largest_component : bool
        Keep only the component of largest area.

    Returns
    -------
    Surface
        `notes` name each change.

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
    if isinstance(surface, str | Path):
        from surfexp.tasks.files import read

        surface = read(surface, repair=True)
    owner = surface if isinstance(surface, Surface) else None
    vertices, faces = arrays_of(surface)
    mesh, changes, origin = repaired_mesh(vertices, faces, largest_component=largest_component)
    if owner is None:
        return Surface(mesh, notes=changes)
    return replace(
        owner,
        mesh=mesh,
        scalars={name: values[origin] for name, values in owner.scalars.items()},
        labels={name: replace(table, keys=table.keys[origin]) for name, table in owner.labels.items()},
        mask=None if owner.mask is None else owner.mask[origin],
        coordinates=None if owner.coordinates is None else owner.coordinates[origin],
        truth=Truth(),
        shape=None,
        part=None,
        notes=(*owner.notes, *changes),
    )
