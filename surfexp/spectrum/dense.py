"""All eigenpairs of a small pencil, by dense algebra."""

from __future__ import annotations

from scipy.linalg import eigh
from scipy.sparse import csr_array

from surfexp.spectrum.eigensystem import SMALLEST_GAP, EigenSystem, measure, measured


def dense(stiffness: csr_array, mass: csr_array, k: int) -> EigenSystem:
    """Find the k lowest pairs with LAPACK, complete because all n values are found."""
    values, vectors = eigh(stiffness.toarray(), mass.toarray())
    n = len(values)
    edge = 0.5 * float(values[k - 1] + values[k]) if k < n else float(values[-1]) + 1.0
    notes: tuple[str, ...] = ()
    if k < n and values[k] - values[k - 1] <= SMALLEST_GAP * abs(values[k]):
        notes = (f"k = {k} cuts a cluster of nearly equal eigenvalues",)
    below = int((values < edge).sum())
    lowest = vectors[:, :k].copy(order="F")
    return measured(
        *(measure(stiffness, mass, lowest), lowest, "dense"),
        inertia=((edge, below),),
        complete=True,
        notes=notes,
    )
