"""Whether two merge trees are interleaved: a lower bound that sees which branch joins which."""

from __future__ import annotations

from surfexp.skeleton.reeb_distance.extended_persistence import MergeTree


def may_be_interleaved(first: MergeTree, second: MergeTree, shift: float, most: int) -> bool:
    """Search maps of the minima of each tree to those of the other that raise every height by the shift.

    A map of trees is known by its minima. It is one of trees where minima that have come together stay together, and two maps
    interleave where there and back again is the way up by twice the shift (Morozov, Beketayev, Weber 2013).

    Parameters
    ----------
    first, second : MergeTree
    shift : float
    most : int
        Pairs tried before the search gives up.

    Returns
    -------
    bool
        False is proved; true also where the search gave up.
    """
    ours, theirs = first.merges.tolist(), second.merges.tolist()
    forth: list[int] = []
    back: list[int] = []
    tried = 0

    def extended() -> bool:
        nonlocal tried
        going = len(forth) < len(ours)
        chosen, here, there = (forth, ours, theirs) if going else (back, theirs, ours)
        leaf = len(chosen)
        if leaf == len(here):
            return True
        for image in range(len(there)):
            tried += 1
            if tried > most:
                return True
            if any(there[image][other] > here[leaf][at] + shift for at, other in enumerate([*chosen, image])):
                continue
            if not going and any(
                ours[image][at] > ours[at][at] + 2 * shift for at, middle in enumerate(forth) if middle == leaf
            ):
                continue
            if not going and theirs[forth[image]][leaf] > theirs[leaf][leaf] + 2 * shift:
                continue
            chosen.append(image)
            if extended():
                return True
            chosen.pop()
        return False

    return extended()
