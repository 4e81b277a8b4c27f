"""Arrays for a page: numbers as codes of 16 bits, codes as deflated text that a browser unpacks."""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats

LAST = 65535  # the largest code; that of NaN where there are gaps
Codes = NDArray[np.unsignedinteger[Any]]


@dataclass(frozen=True, eq=False)
class Quantised:
    """Numbers in equal steps between the least and the greatest of each column: value = low + step * code.

    Parameters
    ----------
    codes : (n, c) uint16
    low, step : tuple of c float
    gaps : bool
        Whether the code 65535 stands for what is not finite. Without gaps it is the greatest value.
    """

    codes: NDArray[np.uint16]
    low: tuple[float, ...]
    step: tuple[float, ...]
    gaps: bool

    def values(self) -> Floats:
        """(n, c) the numbers again, each within half a step; NaN in the gaps."""
        found = np.asarray(self.low) + np.asarray(self.step) * self.codes
        return np.where(self.gaps & (self.codes == LAST), np.nan, found)


def quantised(values: Floats) -> Quantised:
    """Quantise (n,) or (n, c) numbers; the step is the extent of a column over 65535, or 65534 where there are gaps.

    Raises
    ------
    ValueError
        If a column spans more than the largest number.
    """
    table = np.asarray(values, dtype=np.float64)
    table = table[:, None] if table.ndim == 1 else table
    finite = np.isfinite(table)
    gaps = not finite.all()
    low, high = (
        np.where(finite.any(axis=0), pick(table, axis=0, where=finite, initial=far), 0.0)
        for pick, far in ((np.min, np.inf), (np.max, -np.inf))
    )
    with np.errstate(over="ignore"):
        extent = high - low
    if not np.isfinite(extent).all():
        raise ValueError(f"values from {low.min():g} to {high.max():g} span more than a number of 64 bits holds")
    step = extent / (LAST - gaps)
    places = (np.where(finite, table, low) - low) / np.where(step > 0.0, step, 1.0)
    codes = np.where(finite, np.rint(places), LAST).astype(np.uint16)
    return Quantised(codes, tuple(low.tolist()), tuple(step.tolist()), gaps)


def exact_codes(values: Floats) -> Codes:
    """Return (n,) numbers as (n, 2) words of 32 bits, the low one first: where equal steps are too coarse."""
    return np.ascontiguousarray(values, dtype="<f8").view("<u4").reshape(-1, 2).astype(np.uint32)


def packed(codes: Codes) -> str:
    """Text of (n, c) codes: column after column as differences, low bytes before high ones, deflated, in base64.

    Neighbours on a surface are near in memory too: their differences are small, and high bytes mostly 0 or 255.
    """
    flat = codes.T.ravel()
    differences = np.diff(flat, prepend=flat.dtype.type(0)).astype(flat.dtype.newbyteorder("<"))
    planes = differences.view(np.uint8).reshape(-1, flat.itemsize).T
    return base64.b64encode(zlib.compress(planes.tobytes(), 6)).decode()


def unpacked(text: str, like: np.dtype[Any], columns: int) -> Codes:
    """Return (n, c) codes of a text, as the script of the page does; the inverse of `packed`."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).reshape(like.itemsize, -1)
    differences = np.ascontiguousarray(planes.T).view(like.newbyteorder("<")).ravel()
    return np.cumsum(differences, dtype=like).reshape(columns, -1).T
