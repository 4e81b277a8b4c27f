"""Whether every method can work with a surface, asked once for each surface and of the part inside its mask alone."""

from __future__ import annotations

from weakref import WeakSet

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers
from surfexp.mesh.orientation import corner_fans, fans_per_vertex
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart, surface_part
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.mesh.validate import require_valid

REPAIR_ARRAYS = "sx.repair(surface) repairs it"
# surfaces are not changed, so that each is judged once
_SOUND: WeakSet[Surface] = WeakSet()


def sound_part(surface: Surface, name: str, repair: str = REPAIR_ARRAYS) -> Surface:
    """Return a surface whose part inside the mask every method can work with.

    Vertices that no face names, and those without a finite position, do not matter: `part_of_task.part_for` leaves them outside.
    Where a mask leaves faces that touch in a vertex alone, they may.

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
        allow = ("non-manifold vertices",) if _pinched_by_mask(mesh, part) else ()
        require_valid(part.mesh, name, allow=allow, repair=repair, numbers=(part.vertices, faces))
    _SOUND.add(surface)
    return surface


def _pinched_by_mask(mesh: TriangleMesh, part: SurfacePart) -> bool:
    """Whether the part touches itself only at vertices where the surface is sound: there the mask alone parts the faces.

    No method minds, and no repair could help: the surface has nothing to split.
    """
    pinched = part.vertices[_fans(part.mesh) > 1]
    return len(pinched) > 0 and bool((_fans(mesh)[pinched] == 1).all())


def _fans(mesh: TriangleMesh) -> Integers:
    """(n,) fans of faces at each vertex."""
    return fans_per_vertex(mesh, corner_fans(mesh, np.ones(len(mesh.edges), dtype=bool)))


def usable_vertices(mesh: TriangleMesh) -> NDArray[np.bool_]:
    """Return which vertices belong to a face and have a finite position."""
    used = np.zeros(len(mesh.vertices), dtype=bool)
    used[mesh.faces] = True
    return used & np.isfinite(mesh.vertices).all(axis=1)
