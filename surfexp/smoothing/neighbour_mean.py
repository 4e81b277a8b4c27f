"""The mean over a vertex and its neighbours, again and again: the filter of many imaging packages."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array, eye_array

from surfexp.contract.arrays import Floats, Integers


def neighbour_mean(faces: Integers, values: Floats, iterations: int) -> Floats:
    """Return a map after `iterations` means over each vertex and its neighbours, all of one weight.

    Lengths and areas do not enter: how far it reaches depends on the mesh, and the mean over the area is not kept.

    Parameters
    ----------
    faces : (m, 3) int64
    values : (n,) or (n, c) float64
    iterations : int

    Returns
    -------
    like `values`

    Raises
    ------
    ValueError
        If the number of iterations is negative.
    """
    if iterations < 0:
        raise ValueError(f"iterations is {iterations}, must be 0 or more")
    count = len(values)
    tails, heads = faces[:, [0, 1, 1, 2, 2, 0]].ravel(), faces[:, [1, 0, 2, 1, 0, 2]].ravel()
    adjacency = csr_array((np.ones(len(tails)), (tails, heads)), shape=(count, count))
    adjacency.data[:] = 1.0
    near = csr_array(adjacency + eye_array(count))
    step = diags_array(1.0 / near.sum(axis=1)) @ near
    for _ in range(iterations):
        values = step @ values
    return values
