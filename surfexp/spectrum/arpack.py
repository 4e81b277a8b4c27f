"""ARPACK, shifted and inverted just below zero: the plain reference."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from surfexp.contract.arrays import Floats
from surfexp.spectrum.dense import factor_above
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.eigensystem import EigenSystem, clusters, measure, measured
from surfexp.spectrum.shifted_pencil import ShiftedPencil

MORE = (1, 12, 60)


def arpack(stiffness: csr_array, mass: csr_array, k: int, tolerance: float = 1e-8, seed: int = 0) -> EigenSystem:
    """Find the k lowest pairs by implicitly restarted Lanczos (Lehoucq, Sorensen and Yang 1998), then count by inertia.

    A few values more than k are asked for, so that the count can be taken in a gap above the cluster of the k-th.

    Raises
    ------
    EigensolverError
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
    stop = k
    for more in MORE:
        asked = min(k + more, n - 1)
        try:
            values, vectors = eigsh(
                pencil.stiffness, asked, pencil.mass, sigma=shift, OPinv=inverse, v0=start, tol=1e-4 * tolerance
            )
        except (ArpackError, np.linalg.LinAlgError) as cause:
            raise EigensolverError(f"ARPACK does not converge ({cause}): take method slicing") from cause
        order = np.argsort(values)
        values, vectors = values[order], vectors[:, order]
        stop = next((stop for start, stop in clusters(values) if start < k <= stop), k)
        if stop < asked:
            break
    notes: tuple[str, ...] = ()
    if stop > k:
        notes = (f"k = {k} cuts a cluster of nearly equal eigenvalues: k = {stop} contains all of it",)
    edge = factor_above(pencil, values, stop)
    unpermuted = np.empty((n, k), order="F")
    unpermuted[pencil.order] = vectors[:, :k]
    return measured(
        *(measure(stiffness, mass, unpermuted, spacing=max(edge, 0.0) / stop), unpermuted, "arpack"),
        inertia=((edge, pencil.counts[edge]),),
        complete=pencil.counts[edge] == stop and bool(edge - values[stop - 1] > pencil.doubts[edge]),
        notes=notes,
    )
