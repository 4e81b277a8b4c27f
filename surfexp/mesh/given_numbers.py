"""Numbers and words that a person hands in: checked, and refused in one line that names argument, value and bound."""

from __future__ import annotations

import operator
from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

import numpy as np

from surfexp.contract.threads import all_cores

# from here on not every whole number is a float64
LARGEST_WHOLE = 2.0**53
# characters of what was given, in a message
LONGEST_SHOWN = 60
# that a message lists
MOST_WORDS = 20


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


def given_threads(given: Any) -> int:
    """Return a number of threads: as given, or all cores that this process may use.

    Parameters
    ----------
    given : int or None

    Returns
    -------
    int

    Raises
    ------
    ValueError
        If it is no whole number from 1 on.
    """
    return all_cores() if given is None else whole_number(given, "threads", 1)


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


def _shown(given: Any) -> str:
    """What was given, on one line of bounded length."""
    try:
        text = " ".join(repr(given).split())
    except ValueError:  # a whole number of more digits than Python prints
        text = f"a {type(given).__name__}"
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}..."
