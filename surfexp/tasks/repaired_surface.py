"""A surface without the defects of its mesh, on the vertices of its file."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.mesh.both_hemispheres import joined
from surfexp.mesh.coloured_labels import coloured_as
from surfexp.mesh.file_vertices import under_own_numbers
from surfexp.mesh.repair import repair
from surfexp.mesh.surface import Surface, Truth


def repaired(surface: Surface, largest_component: bool = False, renumber: bool = False) -> Surface:
    """Return a surface without repairable defects; its maps, labels and mask follow.

    Parameters
    ----------
    surface : Surface
    largest_component : bool
        Keep only the component of largest area, of both hemispheres that of each.
    renumber : bool
        Drop vertices without faces, which ends the numbering of the file.

    Raises
    ------
    ValueError
        If a defect cannot be repaired, or nothing would be left.
    """
    if surface.right is not None:
        halves = (replace(one, notes=()) for one in surface.hemispheres().values())
        left, right = (repaired(one, largest_component, renumber) for one in halves)
        whole = joined(left, right, surface.name)
        labels = {name: coloured_as(table, surface.labels[name]) for name, table in whole.labels.items()}
        return replace(whole, labels=labels, notes=(*surface.notes, *whole.notes))
    given = surface.mesh
    found = repair(given.vertices, given.faces, largest_component=largest_component)
    mesh, file, origin = found.mesh, None, found.origin
    changes = found.changes
    if not renumber:
        mesh, own = under_own_numbers(given.vertices, given.faces, found)
        origin = own.origin
        file = own if surface.file is None else surface.file.then(own)
        if np.array_equal(file.origin, file.standing):
            file = None
        copies = len(mesh.vertices) - len(given.vertices)
        changes = tuple(
            change.replace("dropped, because no face uses them", "left without a face") for change in changes
        )
        if copies:
            changes = (*changes, f"added behind the vertices of the file: {copies} copies of vertices that were split")
    return replace(
        surface,
        mesh=mesh,
        scalars={name: values[origin] for name, values in surface.scalars.items()},
        labels={name: replace(table, keys=table.keys[origin]) for name, table in surface.labels.items()},
        mask=None if surface.mask is None else surface.mask[origin],
        coordinates=None if surface.coordinates is None else surface.coordinates[origin],
        truth=Truth(),
        shape=None,
        part=None,
        notes=(*surface.notes, *changes),
        file=file,
    )
