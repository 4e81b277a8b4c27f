"""Whether every method can work with a surface, asked once for each surface and of the part inside its mask alone."""

from __future__ import annotations

from weakref import WeakSet

import numpy as np
from numpy.typing import NDArray

from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import surface_part
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import require_valid

REPAIR_ARRAYS = "sx.repair(surface) repairs it"
# surfaces are not changed, so that each is judged once
_SOUND: WeakSet[Surface] = WeakSet()


def sound_part(surface: Surface, name: str, repair: str = REPAIR_ARRAYS) -> Surface:
    """Return a surface whose part inside the mask every method can work with.

    Vertices that no face names, and those without a finite position, do not matter: `inputs.part_for` leaves them outside.

    Parameters
    ----------
    surface : Surface
    name : str
        For the message.
    repair : str
        What repairs it.

    Raises
    ------
    ValueError
        If what is inside has a defect.
    """
    if surface in _SOUND:
        return surface
    if surface.right is not None:
        for side, one in surface.hemispheres().items():
            sound_part(one, f"{name}, {side}", repair)
        _SOUND.add(surface)
        return surface
    mesh = surface.mesh
    usable = usable_vertices(mesh)
    inside = usable if surface.mask is None else usable & surface.mask
    if inside.all() or not inside.any():
        require_valid(mesh, name, repair=repair)
    else:
        part = surface_part(mesh, inside)
        faces = np.flatnonzero(inside[mesh.faces].all(axis=1))
        require_valid(part.mesh, name, repair=repair, numbers=(part.vertices, faces))
    _SOUND.add(surface)
    return surface


def usable_vertices(mesh: TriangleMesh) -> NDArray[np.bool_]:
    """Return which vertices belong to a face and have a finite position."""
    used = np.zeros(len(mesh.vertices), dtype=bool)
    used[mesh.faces] = True
    return used & np.isfinite(mesh.vertices).all(axis=1)
