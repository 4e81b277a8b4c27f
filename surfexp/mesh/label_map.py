"""Labels of vertices, with the name of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Integers


@dataclass(frozen=True, eq=False)
class LabelMap:
    """One label a vertex.

    Parameters
    ----------
    keys : (n,) int64
        The label of each vertex; one that `names` lacks means none.
    names : dict of int to str
        What each label stands for.

    Raises
    ------
    ValueError
        If two labels have one name.
    """

    keys: Integers
    names: Mapping[int, str]

    def __post_init__(self) -> None:
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
