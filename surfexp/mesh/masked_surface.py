"""A surface cut down to its mask, with everything that belongs to its vertices."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import surface_part


def cut_to_mask(surface: Surface, mask: ArrayLike | None) -> Surface:
    """Return the part of a surface inside a mask as a surface of its own; `part` tells which vertices it has kept.

    Parameters
    ----------
    surface : Surface
    mask : (n,) bool, or numbers of which 0 is outside, optional
        None: all of it.

    Raises
    ------
    ValueError
        As `surface_part`.
    """
    part = surface_part(surface.mesh, mask)
    if part.is_whole:
        return replace(surface, mask=None)
    kept = part.vertices
    truth = replace(
        surface.truth,
        labels=None if surface.truth.labels is None else surface.truth.labels[kept],
        origin=None if surface.truth.origin is None else surface.truth.origin[kept],
    )
    said = f"The mask keeps {len(kept)} of {part.whole_count} vertices; nothing outside of it takes part."
    return replace(
        surface,
        mesh=part.mesh,
        scalars={name: np.asarray(values)[kept] for name, values in surface.scalars.items()},
        labels={name: replace(table, keys=table.keys[kept]) for name, table in surface.labels.items()},
        coordinates=None if surface.coordinates is None else surface.coordinates[kept],
        truth=truth,
        mask=None,
        part=part,
        file=None,
        right=None if surface.right is None else surface.right[kept],
        notes=(*surface.notes, said, *part.notes),
    )
