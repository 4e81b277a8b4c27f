"""ARPACK, shifted and inverted just below zero: the plain reference."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import LinearOperator, eigsh

from surfexp.mesh.triangle_mesh import Floats
from surfexp.spectrum.eigensystem import SMALLEST_GAP, EigenSystem, measure, measured
from surfexp.spectrum.shifted_pencil import ShiftedPencil


def arpack(stiffness: csr_array, mass: csr_array, k: int, tolerance: float = 1e-8, seed: int = 0) -> EigenSystem:
    """Find the k lowest pairs by implicitly restarted Lanczos (Lehoucq, Sorensen and Yang 1998), then count by inertia.

    One value more than k is asked for, so that the count can be taken between the last two.

    Raises
    ------
    ValueError
        If it does not converge.
    """
    pencil = ShiftedPencil(stiffness, mass)
    n = pencil.size
    shift, factors = pencil.factor(-0.01 * 4.0 * np.pi / float(mass.sum()))
    block = np.zeros((n, 8))

    def solve(load: Floats) -> Floats:
        block[:] = 0.0
        block[:, 0] = load.ravel()
        factors.solve_in_order(block)
        return block[:, 0].copy()

    inverse = LinearOperator((n, n), matvec=solve, dtype=np.float64)
    start = np.random.default_rng(seed).normal(size=n)
    values, vectors = eigsh(
        pencil.stiffness, k + 1, pencil.mass, sigma=shift, OPinv=inverse, v0=start, tol=1e-4 * tolerance
    )
    order = np.argsort(values)
    values, vectors = values[order], vectors[:, order]
    notes: tuple[str, ...] = ()
    if values[k] - values[k - 1] <= SMALLEST_GAP * abs(values[k]):
        notes = (f"k = {k} cuts a cluster of nearly equal eigenvalues",)
    edge = pencil.factor(0.5 * float(values[k - 1] + values[k]))[0]
    unpermuted = np.empty((n, k), order="F")
    unpermuted[pencil.order] = vectors[:, :k]
    return measured(
        *(measure(stiffness, mass, unpermuted), unpermuted, "arpack"),
        inertia=((edge, pencil.counts[edge]),),
        complete=pencil.counts[edge] == k and not notes,
        notes=notes,
    )
