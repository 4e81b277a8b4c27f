"""The spectrum as LaPy finds it: ARPACK without a count of what it may have left out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse.linalg import eigsh

from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem, measure, measured

SHIFT = -0.01


def usual_spectrum(operator: SurfaceOperator, count: int, seed: int = 0) -> EigenSystem:
    """Return what ARPACK does, called as LaPy calls it: shift-invert about -0.01, tolerance 0, a random start.

    Parameters
    ----------
    operator : SurfaceOperator
        Linear elements.
    count : int
        Number of pairs, below that of the vertices.
    seed : int
        Of the start vector.

    Returns
    -------
    EigenSystem
        `complete` is False: nothing is proved.

    Raises
    ------
    ValueError
        If there are too few vertices.
    """
    stiff, mass = stiffness(operator), mass_matrix(operator)
    if not 1 <= count < stiff.shape[0] - 1:
        raise ValueError(f"count = {count} pairs of {stiff.shape[0]} vertices: take 1 to {stiff.shape[0] - 2}")
    start = np.random.default_rng(seed).uniform(-1.0, 1.0, stiff.shape[0])
    _, vectors = eigsh(stiff, count, mass, sigma=SHIFT, v0=start)
    vectors = np.asfortranarray(vectors)
    return replace(
        measured(measure(stiff, mass, vectors), vectors, "arpack as LaPy calls it"), area=float(operator.areas.sum())
    )
