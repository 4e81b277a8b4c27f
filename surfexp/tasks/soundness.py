"""Whether every method can work with a surface, asked once for each surface and of the part inside its mask alone."""

from __future__ import annotations

from dataclasses import replace
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

    Vertices that no face names, and those without a finite position, are outside: results are NaN there, and the numbering stays.

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
    mesh = surface.mesh
    used, known = _used(mesh), np.isfinite(mesh.vertices).all(axis=1)
    inside = used & known if surface.mask is None else used & known & surface.mask
    if inside.all() or not inside.any():
        require_valid(mesh, name, repair=repair)
    else:
        require_valid(surface_part(mesh, inside).mesh, name, repair=repair)
        lost = [(~known, "vertices have no finite position"), (~used, "vertices belong to no face")]
        notes = [f"{where.sum()} of {len(used)} {what}: they are outside." for where, what in lost if where.any()]
        if notes:
            surface = replace(surface, mask=inside, notes=(*surface.notes, *notes))
    _SOUND.add(surface)
    return surface


def usable_vertices(mesh: TriangleMesh) -> NDArray[np.bool_]:
    """Return which vertices belong to a face and have a finite position."""
    return _used(mesh) & np.isfinite(mesh.vertices).all(axis=1)


def _used(mesh: TriangleMesh) -> NDArray[np.bool_]:
    used = np.zeros(len(mesh.vertices), dtype=bool)
    used[mesh.faces] = True
    return used
