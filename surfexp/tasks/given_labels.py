"""What is accepted as labels of vertices, from whoever gives them: numbers, of which 0 and NaN are none, or names."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Integers
from surfexp.io.hemisphere import check_same_side
from surfexp.io.label_colours import read_coloured_labels
from surfexp.mesh.coloured_labels import coloured_as
from surfexp.mesh.given_arrays import index_array, real_array
from surfexp.mesh.given_numbers import one_of
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import HEMISPHERES, Surface
from surfexp.tasks.both_files import labels_of_both, labels_of_sides
from surfexp.tasks.given_surface import sides_of
from surfexp.tasks.maps_of_file import vertices_of_file


def labels_on(surface: Surface, given: Any) -> LabelMap:
    """Return labels on the vertices of a surface; those of a file that was repaired are carried over.

    Parameters
    ----------
    surface : Surface
    given : str, path, LabelMap or (n,) array_like, or for both hemispheres a mapping of left and right to one of them each
        The name of labels of the surface, a file of labels, or as `labels_of_array` takes them. What has one name on both
        sides is one label.

    Returns
    -------
    LabelMap
        With the colours of what was given.

    Raises
    ------
    ValueError
        If there are fewer or more, a side is missing, a number is no whole one, or a file cannot be read.
    """
    if isinstance(given, str | Path):
        return _named_or_read(surface, given)
    parts = sides_of(given, "data")
    if parts is None:
        table = given if isinstance(given, LabelMap) else labels_of_array(given)
        return coloured_as(LabelMap(as_labels(surface, table.keys), table.names), table)
    if surface.right is not None and all(isinstance(one, str | Path) for one in parts.values()):
        return labels_of_both(surface, parts)
    if surface.right is None:
        if surface.hemisphere not in parts:
            raise ValueError(f"labels have {' and '.join(parts)}, the surface is of hemisphere {surface.hemisphere!r}")
        return labels_on(surface, parts[surface.hemisphere])
    if missing := [side for side in HEMISPHERES if side not in parts]:
        raise ValueError(f"labels have no {missing[0]} hemisphere, the surface is both: give both")
    tables = (one if isinstance(one, LabelMap) else labels_of_array(one) for one in map(parts.__getitem__, HEMISPHERES))
    return labels_of_sides(surface, *tables)


def _named_or_read(surface: Surface, given: str | Path) -> LabelMap:
    """Return the labels that a surface has under a name, else those of a file."""
    if given in surface.labels or not Path(given).is_file():
        if not surface.labels:
            raise ValueError(
                f"labels are {str(given)!r}: there is no such file, and surface {surface.name!r} carries no labels"
            )
        return labels_on(surface, surface.labels[one_of(str(given), "labels", surface.labels)])
    if surface.right is not None:
        return labels_of_both(surface, given)
    check_same_side("labels", given, surface.hemisphere)
    return labels_on(surface, read_coloured_labels(given, surface.hemisphere, vertices_of_file(surface)))


def labels_of_array(given: ArrayLike) -> LabelMap:
    """Return labels that are whole numbers, which are their own names, or texts.

    Parameters
    ----------
    given : (n,) array_like
        0, NaN and what a masked array hides are none; so is, among texts, what is None, NaN or empty.

    Returns
    -------
    LabelMap

    Raises
    ------
    ValueError
        If a number is no whole one.

    Examples
    --------
    >>> labels_of_array([2.0, np.nan, 7.0]).names
    {2: '2', 7: '7'}
    >>> labels_of_array(["V1", "V2", "V1"]).keys.tolist()
    [1, 2, 1]
    """
    if isinstance(given, np.ma.MaskedArray) and given.dtype.kind in "UO":
        given = given.filled("")
    hidden = isinstance(given, np.ma.MaskedArray)
    listed = [] if hidden else np.asarray(given).ravel().tolist()
    if any(isinstance(one, str) for one in listed):
        words = np.array([one if isinstance(one, str) else "" if is_missing(one) else str(one) for one in listed])
        names, numbers = np.unique(words[words != ""], return_inverse=True)
        keys = np.zeros(words.shape, dtype=np.int64)
        keys[words != ""] = 1 + numbers
        return LabelMap(keys.reshape(np.shape(given)), dict(enumerate(names.tolist(), 1)))
    if hidden or np.asarray(given).dtype.kind in "fO":
        values = real_array(given, "labels")
        given = np.where(np.isnan(values), 0.0, values)
    keys = index_array(given, "labels")
    return LabelMap(keys, {key: str(key) for key in np.unique(keys).tolist() if key != 0})


def is_missing(cell: Any) -> bool:
    """Whether a cell of a table is None, NaN, or pandas's NA, which is not equal to itself nor unequal.

    Examples
    --------
    >>> is_missing(float("nan")), is_missing(None), is_missing(0)
    (True, True, False)
    """
    return cell is None or not isinstance(same := cell == cell, bool | np.bool_) or not same


def are_labels(given: Any) -> bool:
    """Whether an array, or a column of a table, holds names; or each hemisphere has names, whole numbers or a LabelMap.

    A list of texts is one of names of maps, texts that are all numbers are a map that was not read as one, and one array of
    whole numbers may be a map.

    Examples
    --------
    >>> are_labels(np.array(["V1", "V2"])), are_labels(["thickness", "sulc"]), are_labels(np.zeros(2))
    (True, False, False)
    >>> are_labels(np.array(["0.25", "3"]))
    False
    >>> are_labels({"left": np.array([1, 2]), "right": np.array([2, 1])})
    True
    """
    if (parts := sides_of(given, "data")) is not None:
        return all(isinstance(one, LabelMap) or are_labels(one) or _are_whole(one) for one in parts.values())
    if isinstance(given, LabelMap) or not hasattr(given, "dtype") or not hasattr(given, "__len__"):
        return False
    array = np.asarray(given)
    if array.dtype.kind not in "UO":
        return False
    words = {one for one in array.ravel().tolist() if isinstance(one, str)}
    return bool(words) and not all(map(_is_number, words))


def _are_whole(given: Any) -> bool:
    return not isinstance(given, str) and np.asarray(given).dtype.kind in "iu"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def as_labels(surface: Surface, keys: Integers) -> Integers:
    """Return (n,) labels on the vertices of a surface; those of a file that was repaired are carried over.

    Raises
    ------
    ValueError
        If there are fewer or more.
    """
    if surface.file is not None and len(keys) == len(surface.file.standing):
        keys = np.asarray(surface.file.onto_mesh(keys))
    if len(keys) != len(surface.mesh.vertices):
        raise ValueError(f"labels have shape {np.shape(keys)}, the surface has {len(surface.mesh.vertices)} vertices")
    return np.asarray(keys, dtype=np.int64)
