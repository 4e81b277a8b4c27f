"""Blocks of nearly equal eigenvalues, inside which single eigenfunctions are arbitrary."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from surfexp.contract.arrays import Floats

Blocks = tuple[tuple[int, int], ...]
RELATIVE_GAP = 0.03


def eigenvalue_blocks(*spectra: Floats, gap: float = RELATIVE_GAP) -> Blocks:
    """Return ranges (start, stop) that cover all values; a range ends where every spectrum has a relative gap.

    Parameters
    ----------
    spectra : (n,) float64 each
        Increasing and positive, such as those of two surfaces.
    gap : float
        Values nearer than this, relatively, belong together.
    """
    if not 0.0 <= gap < 1.0:
        raise ValueError(f"relative gap {gap:g}, take one from 0 to below 1")
    lengths = {len(values) for values in spectra}
    if len(lengths) != 1 or 0 in lengths:
        raise ValueError(f"spectra have lengths {sorted(lengths)}, equal and positive ones are needed")
    apart = np.all([values[1:] - values[:-1] > gap * values[1:] for values in spectra], axis=0)
    edges = [0, *(np.flatnonzero(apart) + 1).tolist(), *lengths]
    return tuple(pairwise(edges))


def size_at_gap(n: int, *spectra: Floats, gap: float = RELATIVE_GAP) -> int:
    """Return the size nearest to n, the smaller of two, at which no block of nearly equal values is cut.

    The spectra have to be longer than n, so that the gap after the n-th value can be seen.
    """
    shortest = min(len(values) for values in spectra)
    if n < 1 or n >= shortest:
        raise ValueError(
            f"n = {n} of {shortest} eigenvalues: take 1 <= n <= {shortest - 1}, the next one shows the gap"
        )
    blocks = eigenvalue_blocks(*(values[:shortest] for values in spectra), gap=gap)
    whole = [stop for _, stop in blocks if stop < shortest]
    if not whole:
        raise ValueError(
            f"the first {shortest} eigenvalues have no relative gap above {gap:g}: lower it, or compute more"
        )
    return min(whole, key=lambda size: (abs(size - n), size))
