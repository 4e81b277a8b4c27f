"""What a page claims: arrays, the numbers that say how they are to be read, and the numbers that must come out."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Kind = Literal["duality gap", "spectrum", "signs"]


@dataclass(frozen=True, eq=False)
class Claim:
    """One claim of a page, of which every number is computed again where the page is read.

    Parameters
    ----------
    kind : {"duality gap", "spectrum", "signs"}
        Which check computes it, and says it to a reader.
    arrays : dict of str to array
        Integers are kept as int32, all other numbers as float64.
    numbers : dict
        Parameters of the check.
    stated : dict of str to float
        Numbers that the check must give.
    """

    kind: Kind
    arrays: Mapping[str, NDArray[Any]]
    numbers: Mapping[str, Any]
    stated: Mapping[str, Any]

    def described(self) -> dict[str, Any]:
        """Return the claim as JSON can hold it.

        Returns
        -------
        dict
        """
        return {
            "kind": self.kind,
            "arrays": {name: packed(array) for name, array in self.arrays.items()},
            "numbers": dict(self.numbers),
            "stated": dict(self.stated),
        }


def packed(array: NDArray[Any]) -> dict[str, Any]:
    """Return an array as text: its type, shape, bytes in base64 (little-endian, row after row) and their SHA-256.

    Parameters
    ----------
    array : array of integers or float64
    """
    kind = "int32" if np.issubdtype(array.dtype, np.integer) else "float64"
    data = np.ascontiguousarray(array, dtype=np.dtype(kind).newbyteorder("<")).tobytes()
    digest, text = hashlib.sha256(data).hexdigest(), base64.b64encode(data).decode()
    return {"type": kind, "shape": list(array.shape), "sha256": digest, "data": text}
