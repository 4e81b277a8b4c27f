"""What is accepted as numbers, whole numbers and masks, from whoever gives them, and what is made of it."""

from __future__ import annotations

import operator
from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from surfexp.contract.arrays import Floats, Integers

# beyond it float64 does not hold every whole number
LARGEST_WHOLE = 2.0**53
# characters of what was given, in a message
LONGEST_SHOWN = 60
# that a message lists
MOST_WORDS = 20


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


def whole_number(given: Any, what: str, least: int, most: int | None = None) -> int:
    """Return a whole number within its bounds; 5.0 is one, 2.5, "5" and True are none.

    Parameters
    ----------
    given : int, or a float without a fraction
    what : str
        Name of the argument.
    least : int
    most : int, optional
        2^63 - 1 if not given.

    Returns
    -------
    int

    Raises
    ------
    ValueError
        If it is no whole number, or lies outside of its bounds.
    """
    bounds = f"at least {least}" if most is None else f"{least} to {most}"
    most = np.iinfo(np.int64).max if most is None else most
    try:
        if isinstance(given, bool | np.bool_):
            raise TypeError
        is_float = isinstance(given, float | np.floating) and abs(float(given)) < LARGEST_WHOLE
        number = int(given) if is_float and given == int(given) else operator.index(given)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{what} = {_shown(given)} is no whole number, {bounds} is needed") from None
    if not least <= number <= most:
        raise ValueError(f"{what} = {_shown(number)}, {bounds} is needed")
    return number


def one_of(given: Any, what: str, known: Iterable[str]) -> str:
    """Return one of some words.

    Parameters
    ----------
    given : str
    what : str
        Name of the argument.
    known : iterable of str

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If it is none of them.
    """
    words = tuple(known)
    if not isinstance(given, str) or given not in words:
        # of many the nearest
        near = words if len(words) <= MOST_WORDS else get_close_matches(str(given)[:LONGEST_SHOWN], words, 3, 0.0)
        others = "" if near is words else f" or another of {len(words)} names"
        raise ValueError(f"{what} = {_shown(given)}, choose one of {', '.join(near)}{others}")
    return given


def real_pair(given: Any, what: str) -> tuple[float, float]:
    """Return two finite real numbers.

    Parameters
    ----------
    given : (float, float)
    what : str
        Name of the argument.

    Returns
    -------
    (float, float)

    Raises
    ------
    ValueError
        If they are not two, or one is no finite number.
    """
    if isinstance(given, str) or not isinstance(given, Iterable) or len(pair := list(given)) != 2:
        raise ValueError(f"{what} = {_shown(given)}, two numbers are needed")
    return real_number(pair[0], what), real_number(pair[1], what)


def real_number(given: Any, what: str, above: float | None = None, below: float | None = None) -> float:
    """Return a finite real number between two bounds, which it may not reach.

    Parameters
    ----------
    given : float
    what : str
        Name of the argument.
    above, below : float, optional

    Returns
    -------
    float

    Raises
    ------
    ValueError
        If it is no number, not finite, or not within its bounds.
    """
    bounds = " and ".join(
        f"{word} {bound:g}" for word, bound in (("above", above), ("below", below)) if bound is not None
    )
    needed = f"a number {bounds}".rstrip()
    if isinstance(given, bool | np.bool_ | str | bytes | complex | np.complexfloating) or np.ndim(given):
        raise ValueError(f"{what} = {_shown(given)}, {needed} is needed")
    try:
        number = float(given)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{what} = {_shown(given)}, {needed} is needed") from None
    outside = (above is not None and number <= above) or (below is not None and number >= below)
    if not np.isfinite(number) or outside:
        raise ValueError(f"{what} = {number:g}, {needed} is needed")
    return number


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


def _shown(given: Any) -> str:
    """What was given, on one line of bounded length."""
    try:
        text = " ".join(repr(given).split())
    except ValueError:  # a whole number of more digits than Python prints
        text = f"a {type(given).__name__}"
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}..."


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
