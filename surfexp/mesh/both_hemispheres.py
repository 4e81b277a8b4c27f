"""Two hemispheres as one surface, and each of them out of it again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers
from surfexp.mesh.file_vertices import FileVertices
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.spatial_frame import common_frame
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def joined(left: Surface, right: Surface, name: str = "both hemispheres") -> Surface:
    """Return two hemispheres as one surface: the vertices of the left one, then those of the right one.

    Copies of vertices that a repair has split stand behind both. A map that one side alone has is NaN on the other, and
    labels are -1 there.

    Parameters
    ----------
    left, right : Surface
    name : str

    Returns
    -------
    Surface
        Of hemisphere "both".

    Raises
    ------
    ValueError
        If one says that it is the other hemisphere, or their units differ.
    """
    parts = (left, right)
    for side, part in zip(HEMISPHERES, parts, strict=True):
        if part.hemisphere not in ("", side):
            raise ValueError(
                f"{part.name!r} is given as {side}, it is of hemisphere {part.hemisphere}: give the {side} one"
            )
    if left.unit != right.unit:
        raise ValueError(f"the left hemisphere is in {left.unit!r}, the right one in {right.unit!r}: give one unit")
    counts = [len(part.mesh.vertices) for part in parts]
    copies = np.concatenate([np.arange(len(_file(part).origin)) >= len(_file(part).standing) for part in parts])
    rows = np.argsort(copies, kind="stable")
    number = np.argsort(rows, kind="stable")
    faces = np.concatenate([left.mesh.faces, right.mesh.faces + counts[0]])
    maps, tables = {**left.scalars, **right.scalars}, {**left.labels, **right.labels}
    frame, lost = common_frame(left.frame, right.frame)
    notes = [f"{side}: {note}" for side, part in zip(HEMISPHERES, parts, strict=True) for note in part.notes]
    alone = [key for key in maps if any(key not in part.scalars for part in parts)]
    notes += [f"One hemisphere alone has {', '.join(map(repr, alone))}: NaN on the other."] if alone else []
    return Surface(
        TriangleMesh(np.concatenate([part.mesh.vertices for part in parts])[rows], number[faces]),
        name,
        left.unit,
        {
            key: np.concatenate(
                [part.scalars.get(key, np.full(count, np.nan)) for part, count in zip(parts, counts, strict=True)]
            )[rows]
            for key in maps
        },
        notes=(*notes, *lost),
        mask=_mask(parts, counts, rows),
        labels={key: _labels(parts, counts, key, rows) for key in tables},
        frame=frame,
        file=_joined_file(left, right, rows, number),
        right=rows >= counts[0],
    )


def vertices_of(surface: Surface, side: str) -> Integers:
    """Return the vertices of one hemisphere of a surface that is both, increasing."""
    right = np.zeros(len(surface.mesh.vertices), bool) if surface.right is None else surface.right
    return np.flatnonzero(right if side == "right" else ~right)


def side_of(surface: Surface, vertex: int) -> str:
    """Return the hemisphere of a vertex, nothing where none is known."""
    if surface.right is None:
        return surface.hemisphere
    return HEMISPHERES[int(surface.right[vertex])]


def of_both(
    surface: Surface, left: NDArray[np.generic], right: NDArray[np.generic], what: str = "map"
) -> NDArray[np.generic]:
    """Return rows of the two hemispheres as rows of a surface that is both.

    Parameters
    ----------
    surface : Surface
    left, right : (l, ...), (r, ...) arrays
        On the vertices of each hemisphere, or of its file.
    what : str
        For the message.

    Returns
    -------
    (n, ...) array

    Raises
    ------
    ValueError
        If the surface is not both, or their lengths are others.
    """
    if surface.right is None:
        raise ValueError(f"{what} has two hemispheres, {surface.name!r} is not both")
    file = surface.file
    flags = [surface.right, *([] if file is None else [surface.right[file.standing]])]
    for flag in flags:
        if (len(left), len(right)) == (int((~flag).sum()), int(flag.sum())):
            whole = np.empty((len(flag), *left.shape[1:]), dtype=np.result_type(left, right))
            whole[~flag], whole[flag] = left, right
            return whole if file is None or len(flag) == len(surface.right) else file.onto_mesh(whole)
    wanted = f"{(~surface.right).sum()} left and {surface.right.sum()} right vertices"
    raise ValueError(f"{what} has {len(left)} values left and {len(right)} right, the surface has {wanted}")


def joined_labels(left: LabelMap, right: LabelMap) -> tuple[LabelMap, LabelMap]:
    """Return labels of two hemispheres numbered alike: what has one name has one number.

    Numbers of the left one stay. A number of the right one that stands for another name there gets the next free one; one
    without a name becomes -1 where it would get one.

    Parameters
    ----------
    left, right : LabelMap

    Returns
    -------
    LabelMap, LabelMap
    """
    names, places = dict(left.names), {name: key for key, name in left.names.items()}
    free = 1 + max([*left.names, *right.names, 0])
    renumbered = {}
    for key, name in right.names.items():
        if name not in places:
            places[name] = key if key not in names else free
            free += key in names
            names[places[name]] = name
        renumbered[key] = places[name]
    used, inverse = np.unique(right.keys, return_inverse=True)
    keys = [renumbered.get(key, -1 if key in names else key) for key in used.tolist()]
    lefts = [-1 if key not in left.names and key in names else key for key in left.keys.tolist()]
    return LabelMap(np.array(lefts, np.int64), names), LabelMap(np.array(keys, np.int64)[inverse.ravel()], names)


def _file(part: Surface) -> FileVertices:
    every = np.arange(len(part.mesh.vertices))
    return FileVertices(every, every) if part.file is None else part.file


def _joined_file(left: Surface, right: Surface, rows: Integers, number: Integers) -> FileVertices | None:
    if left.file is None and right.file is None:
        return None
    first, second = _file(left), _file(right)
    origin = np.concatenate([first.origin, second.origin + len(first.standing)])[rows]
    return FileVertices(origin, number[np.concatenate([first.standing, second.standing + len(first.origin)])])


def _mask(parts: Sequence[Surface], counts: Sequence[int], rows: Integers) -> NDArray[np.bool_] | None:
    if all(part.mask is None for part in parts):
        return None
    masks = [
        np.ones(count, bool) if part.mask is None else part.mask for part, count in zip(parts, counts, strict=True)
    ]
    return np.concatenate(masks)[rows]


def _labels(parts: Sequence[Surface], counts: Sequence[int], name: str, rows: Integers) -> LabelMap:
    none = [LabelMap(np.full(count, -1), {}) for count in counts]
    both = joined_labels(*(part.labels.get(name, empty) for part, empty in zip(parts, none, strict=True)))
    return LabelMap(np.concatenate([table.keys for table in both])[rows], both[0].names)
