"""What is accepted as arrays of numbers, indices and masks, from whoever gives them, and what is made of it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.given_numbers import LARGEST_WHOLE


def real_array(given: ArrayLike, what: str, infinite: bool = False) -> Floats:
    """Return real numbers as float64, those that a masked array hides as NaN.

    Parameters
    ----------
    given : array_like
        Of booleans, whole numbers or floating-point numbers.
    what : str
        What the array is, for the message.
    infinite : bool
        Whether infinite values are left to the caller.

    Returns
    -------
    (...) float64

    Raises
    ------
    ValueError
        If it is ragged, complex, a date, text, structured or of objects, or a value is infinite and may not be.
    """
    values = _numbers(given, what, "buif", "real numbers are needed")
    count = 0 if infinite else int(np.isinf(values).sum())
    if count:
        raise ValueError(f"{what} has {count} infinite values of {values.size}; write NaN where nothing is known")
    return values


def index_array(given: ArrayLike, what: str) -> Integers:
    """Return whole numbers as int64.

    Parameters
    ----------
    given : array_like
        Whole numbers; of floating-point numbers those without a fraction.
    what : str
        What the array is, for the message.

    Returns
    -------
    (...) int64

    Raises
    ------
    ValueError
        If the array is of booleans, a number is fractional, hidden, not finite or beyond 2^53.
    """
    array = _array(given, what)
    if array.dtype.kind == "b":
        raise ValueError(f"{what} is an array of booleans, whole numbers are needed: a mask is np.flatnonzero(mask)")
    if array.dtype.kind in "iu" and not isinstance(given, np.ma.MaskedArray):
        if array.size and int(array.max()) > np.iinfo(np.int64).max:
            raise ValueError(f"{what} has the value {array.max()}, the largest is {np.iinfo(np.int64).max}")
        return array.astype(np.int64, copy=False)
    values = real_array(given, what)
    bad = ~(np.isfinite(values) & (np.abs(values) < LARGEST_WHOLE) & (values == np.floor(values)))
    if bad.any():
        raise ValueError(f"{what} has the value {values[bad].ravel()[0]:g}, whole numbers are needed")
    return values.astype(np.int64)


def mask_array(given: ArrayLike, count: int, what: str = "mask") -> NDArray[np.bool_]:
    """Return which of `count` vertices are inside: those whose number is neither 0 nor NaN nor hidden.

    Parameters
    ----------
    given : (n,) array_like
        Booleans, or numbers; a column (n, 1) is one too.
    count : int
    what : str
        What the array is, for the message.

    Returns
    -------
    (n,) bool

    Raises
    ------
    ValueError
        If it has another length, or does not hold numbers.
    """
    values = _numbers(given, what, "buif", "booleans, or 0 outside and 1 inside, are needed")
    values = values.reshape(-1) if values.size == count else values
    if values.shape != (count,):
        raise ValueError(f"{what} has shape {np.shape(given)}, the surface has {count} vertices")
    return np.asarray(np.isfinite(values) & (values != 0))


def frozen(array: NDArray[Any], given: Any) -> NDArray[Any]:
    """Return an array that nobody can change: a copy where whoever gave it could.

    Parameters
    ----------
    array : ndarray
        Made of what was given; perhaps the same memory.
    given : array_like

    Returns
    -------
    ndarray
        Read-only.
    """
    owned = array.copy() if _is_writable(array) and np.may_share_memory(array, np.asarray(given)) else array.view()
    owned.flags.writeable = False
    return owned


def _is_writable(array: Any) -> bool:
    """Whether the memory of an array can be written through it or through an array that it is a view of."""
    while isinstance(array, np.ndarray):
        if array.flags.writeable:
            return True
        array = array.base
    return False


def map_array(given: ArrayLike, what: str) -> Floats:
    """Return the real numbers of a map, a column (n, 1) as (n,); otherwise as `real_array`.

    Parameters
    ----------
    given : array_like
    what : str

    Returns
    -------
    (...) float64

    Raises
    ------
    ValueError
        As `real_array`.
    """
    values = real_array(given, what)
    return values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values


def _array(given: ArrayLike, what: str) -> NDArray[Any]:
    if given is None:
        raise ValueError(f"{what} is None, an array of numbers is needed")
    try:
        return np.asarray(given)
    except (ValueError, TypeError):
        raise ValueError(f"{what} is no array of numbers, rows of equal length are needed") from None


def _numbers(given: ArrayLike, what: str, kinds: str, needed: str) -> Floats:
    array = _array(given, what)
    if array.dtype.kind == "O":
        array = _unboxed(array)
    if array.dtype.names or array.dtype.kind not in kinds:
        kind = "structured" if array.dtype.names else str(array.dtype)
        raise ValueError(f"{what} is an array of type {kind}, {needed}")
    values = array.astype(np.float64, copy=False)
    hidden = np.ma.getmaskarray(given) if isinstance(given, np.ma.MaskedArray) else np.zeros(())
    return np.where(hidden, np.nan, values) if hidden.any() else values


def _unboxed(array: NDArray[Any]) -> NDArray[Any]:
    """Numbers that pandas keeps as objects beside its NA, as numbers; anything else as it is."""
    flat = [np.nan if item is None or type(item).__name__ == "NAType" else item for item in array.ravel().tolist()]
    if array.size and all(isinstance(item, bool | int | float | np.integer | np.floating) for item in flat):
        return np.array(flat, dtype=np.float64).reshape(array.shape)
    return array
