"""Labels of maps: the group, the pair and the block of each."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats, Integers

# how tables write that nothing is known: of one subject it would be a group, and of several a family
UNKNOWN = frozenset(["", "n/a", "na", "nan", "<na>", "nat"])


def codes_of(given: ArrayLike, count: int, what: str) -> tuple[Integers, list[str]]:
    """Return labels as numbers from 0, in the order in which they are named first, with the names.

    Parameters
    ----------
    given : (s,) array_like
        Text or numbers.
    count : int
    what : str
        Name of the argument.

    Returns
    -------
    (s,) int64
    list of str

    Raises
    ------
    ValueError
        If there is not one for each map, or one is missing.
    """
    array: np.ndarray = np.ma.asanyarray(given)
    if array.shape != (count,):
        raise ValueError(f"{what} have shape {array.shape}, one label for each of {count} maps is needed")
    # what a masked array hides is None
    labels = [one.decode("utf-8", "replace") if isinstance(one, bytes) else one for one in array.tolist()]
    missing = [k for k, one in enumerate(labels) if one is None or str(one).strip().lower() in UNKNOWN]
    if missing:
        raise ValueError(
            f"{what} have no label for {len(missing)} of {count} maps (the first is number {missing[0]}, "
            f"{labels[missing[0]]!r}): leave these maps out, or name what they belong to"
        )
    known: dict[str, int] = {}
    return np.array([known.setdefault(str(one), len(known)) for one in labels], dtype=np.int64), list(known)


def two_groups(given: ArrayLike, count: int) -> tuple[Integers, list[str]]:
    """Return to which of two groups each map belongs, 0 for the one that is named first, and their names.

    Parameters
    ----------
    given : (s,) array_like
    count : int

    Returns
    -------
    (s,) int64
    list of str

    Raises
    ------
    ValueError
        If there are not two.
    """
    codes, names = codes_of(given, count, "groups")
    if len(names) != 2:
        raise ValueError(f"groups name {len(names)} ({', '.join(names[:5])}), exactly 2 are needed")
    return codes, names


def differences_of_pairs(data: Floats, groups: ArrayLike, pairs: ArrayLike) -> tuple[Floats, str]:
    """Return of each pair the map of the group that is named first less that of the other.

    Parameters
    ----------
    data : (s, n) float64
    groups, pairs : (s,) array_like

    Returns
    -------
    (s / 2, n) float64
    str
        What is tested.

    Raises
    ------
    ValueError
        If a pair has not one map of each group.
    """
    side, names = two_groups(groups, len(data))
    owner, owners = codes_of(pairs, len(data), "pairs")
    for pair, name in enumerate(owners):
        if sorted(side[owner == pair].tolist()) != [0, 1]:
            found = ", ".join(names[k] for k in side[owner == pair])
            raise ValueError(f"pair {name} has the maps {found}: one {names[0]} and one {names[1]} are needed")
    first, second = (np.flatnonzero(side == k)[np.argsort(owner[side == k])] for k in (0, 1))
    return data[first] - data[second], f"{names[0]} less {names[1]} in pairs"


def blocks_of_pairs(blocks: ArrayLike, pairs: ArrayLike, count: int) -> list[str]:
    """Return the block of each pair, in the order in which pairs are named first.

    Parameters
    ----------
    blocks, pairs : (s,) array_like
    count : int
        Number of maps, s.

    Returns
    -------
    (s / 2,) list of str

    Raises
    ------
    ValueError
        If a pair has maps of two blocks.
    """
    block, names = codes_of(blocks, count, "blocks")
    owner, owners = codes_of(pairs, count, "pairs")
    found = [[names[k] for k in np.unique(block[owner == pair])] for pair in range(len(owners))]
    for pair, own in zip(owners, found, strict=True):
        if len(own) > 1:
            raise ValueError(f"pair {pair} has maps of the blocks {', '.join(own)}: a pair in one block is needed")
    return [own[0] for own in found]
