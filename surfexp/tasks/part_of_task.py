"""The part of a surface on which a task runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.length_scale import scaled
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import Mask, SurfacePart, finite_mask, surface_part
from surfexp.tasks.soundness import usable_vertices


def part_for(surface: Surface, *maps: Floats) -> SurfacePart:
    """Return the part of a surface on which a task runs: where every map is finite, inside the mask if there is one.

    Vertices that belong to no face, or have no finite position, are outside. Notes say which part was taken. Its mesh has
    coordinates of ordinary size: a length on it times `length` is one of the surface.

    Raises
    ------
    ValueError
        If a map is known nowhere, or nowhere inside the mask.
    """
    count = len(surface.mesh.vertices)
    finite, usable = finite_mask(maps, count), usable_vertices(surface.mesh)
    if finite is not None and not finite.any():
        raise ValueError(f"{_known_nowhere(maps, np.ones_like(finite), 'vertices')}: give numbers where it is known")
    inside = usable if surface.mask is None else usable & surface.mask
    if finite is not None and inside.any() and not (finite & inside).any():
        raise ValueError(f"{_known_nowhere(maps, inside, 'vertices inside the mask')}: give another mask")
    part = surface_part(surface.mesh, inside if finite is None else inside & finite)
    mesh, length = scaled(part.mesh)
    notes = _taken(surface, part, maps, finite, usable)
    return replace(part, mesh=mesh, length=length, notes=(*notes, *part.notes))


def _taken(
    surface: Surface, part: SurfacePart, maps: Sequence[Floats], finite: Mask | None, usable: Mask
) -> Iterator[str]:
    """Say which part is taken where nobody asked for one."""
    if lost := int((~usable).sum()):
        yield f"{lost} of {part.whole_count} vertices belong to no face or have no finite position: they are outside."
    if finite is None:
        return
    if surface.mask is None:
        said = f"The map is finite at {len(part.vertices)} of {part.whole_count} vertices: these are the mask."
        yield said + _worst(maps, np.ones_like(usable))
    else:
        inside = usable & surface.mask
        if unknown := int((inside & ~finite).sum()):
            said = f"The map is NaN at {unknown} of the {inside.sum()} vertices inside the mask: they are outside."
            yield said + _worst(maps, inside)


def _unknown(maps: Sequence[Floats], inside: Mask) -> list[int]:
    """At how many vertices each column of the maps is NaN."""
    columns = (column for one in maps for column in one.reshape(len(one), -1).T)
    return [int(np.isnan(column[inside]).sum()) for column in columns]


def _worst(maps: Sequence[Floats], inside: Mask) -> str:
    """Which of several maps knows least, unless all know as much."""
    unknown = _unknown(maps, inside)
    if min(unknown) == max(unknown):
        return ""
    return f" Map {np.argmax(unknown) + 1} of {len(unknown)} alone is NaN at {max(unknown)}."


def _known_nowhere(maps: Sequence[Floats], inside: Mask, where: str) -> str:
    """Which map is NaN at all vertices inside, or knows least where no vertex is known in all of them."""
    unknown, count = _unknown(maps, inside), int(inside.sum())
    worst = f"map {np.argmax(unknown) + 1} of {len(unknown)}" if len(unknown) > 1 else "map"
    if max(unknown) < count:
        return f"none of {count} {where} is known in all maps, {worst} is NaN at {max(unknown)}"
    return f"{worst} is NaN at all {count} {where}"


def require_connected(part: SurfacePart, what: str, both: bool = False) -> None:
    """Refuse a part of several pieces, naming the smallest.

    Parameters
    ----------
    part : SurfacePart
    what : str
        What needs one piece, in the plural.
    both : bool
        Whether the surface is both hemispheres, so that each of them is what to take.

    Raises
    ------
    ValueError
        If it has several.
    """
    labels = part.mesh.component_labels
    sizes = np.bincount(labels)
    if len(sizes) > 1:
        smallest = int(np.argmin(sizes))
        first = int(part.vertices[np.argmax(labels == smallest)])
        if both:
            raise ValueError(
                f"the surface is both hemispheres, {what} need one: give the file of one side, or "
                "surface.hemispheres()['left']"
            )
        raise ValueError(
            f"the surface has {len(sizes)} pieces inside its mask, {what} need one: the smallest has {sizes[smallest]} "
            f"vertices, vertex {first} among them; take the largest: a mask of it, or surfexp repair FILE --largest-component"
        )
