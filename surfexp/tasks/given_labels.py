"""What is accepted as labels of vertices, from whoever gives them: numbers, of which 0 and NaN are none, or names."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from surfexp.mesh.given_arrays import index_array, real_array
from surfexp.mesh.label_map import LabelMap


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
    hidden = isinstance(given, np.ma.MaskedArray)
    listed = [] if hidden else np.asarray(given).ravel().tolist()
    if any(isinstance(one, str) for one in listed):
        words = np.array(["" if one is None or one != one else str(one) for one in listed])
        names, numbers = np.unique(words[words != ""], return_inverse=True)
        keys = np.zeros(words.shape, dtype=np.int64)
        keys[words != ""] = 1 + numbers
        return LabelMap(keys.reshape(np.shape(given)), dict(enumerate(names.tolist(), 1)))
    if hidden or np.asarray(given).dtype.kind in "fO":
        values = real_array(given, "labels")
        given = np.where(np.isnan(values), 0.0, values)
    keys = index_array(given, "labels")
    return LabelMap(keys, {key: str(key) for key in np.unique(keys).tolist() if key != 0})


def are_words(given: Any) -> bool:
    """Whether an array, or a column of a table, holds texts; a list of texts is one of names of maps.

    Examples
    --------
    >>> are_words(np.array(["V1", "V2"])), are_words(["thickness", "sulc"]), are_words(np.zeros(2))
    (True, False, False)
    """
    if not hasattr(given, "dtype") or not hasattr(given, "__len__"):
        return False
    array = np.asarray(given)
    return array.dtype.kind == "U" or (array.dtype.kind == "O" and any(isinstance(one, str) for one in array.ravel()))
