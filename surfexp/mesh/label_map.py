"""Labels of vertices, with the name of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers
from surfexp.mesh.given_arrays import frozen, index_array


@dataclass(frozen=True, eq=False)
class LabelMap:
    """One label a vertex.

    Parameters
    ----------
    keys : (n,) or (n, 1) int64
        The label of each vertex; one that `names` lacks means none. Kept as (n,), read-only.
    names : dict of int to str
        What each label stands for.

    Raises
    ------
    ValueError
        If two labels have one name, or there is not one whole number a vertex.
    """

    keys: Integers
    names: Mapping[int, str]

    def __post_init__(self) -> None:
        keys = index_array(self.keys, "labels")
        keys = keys[:, 0] if keys.ndim == 2 and keys.shape[1] == 1 else keys
        if keys.ndim != 1:
            raise ValueError(f"labels have shape {keys.shape}, one whole number a vertex is needed")
        object.__setattr__(self, "keys", frozen(keys, self.keys))
        listed = list(self.names.values())
        if len(set(listed)) < len(listed):
            twice = next(name for name in listed if listed.count(name) > 1)
            raise ValueError(f"the name {twice!r} stands for two labels, each needs its own")

    def where(self, name: str) -> NDArray[np.bool_]:
        """Return which vertices have the label of a name.

        Parameters
        ----------
        name : str

        Returns
        -------
        (n,) bool

        Raises
        ------
        ValueError
            If no label has it.
        """
        wanted = [key for key, known in self.names.items() if known == name]
        if not wanted:
            from difflib import get_close_matches

            nearest = get_close_matches(name, list(self.names.values()), 1, 0.0)
            hint = f"the nearest of {len(self.names)} is {nearest[0]!r}" if nearest else "the table of labels is empty"
            raise ValueError(f"no label is named {name!r}, {hint}")
        return np.asarray(self.keys == wanted[0])
