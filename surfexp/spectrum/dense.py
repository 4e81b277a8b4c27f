"""All eigenpairs of small pencils by dense algebra, one or a stack of them, counted apart by a sparse factorisation."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.eigensystem import EigenSystem, clusters, mean_spacing, measure, measured
from surfexp.spectrum.shifted_pencil import ShiftedPencil

LARGEST_DENSE_SIZE = 6000


def dense(stiffness: csr_array, mass: csr_array, k: int, tolerance: float = 1e-8) -> EigenSystem:
    """Find the k lowest pairs of a pencil with LAPACK.

    They are complete where the sparse LDL^T of A - s B, which knows nothing of them, counts as many below a gap.
    """
    weyl = 4.0 * np.pi / float(mass.sum())
    stacks = dense_pairs(stiffness.toarray()[None], mass.toarray()[None], tolerance, weyl)
    values, vectors = stacks[0][0], stacks[1][0]
    stop = _whole_cluster(values, k)
    pencil = ShiftedPencil(stiffness, mass)
    edge = factor_above(pencil, values, stop)
    notes: tuple[str, ...] = ()
    if stop > k:
        notes = (f"k = {k} cuts a cluster of nearly equal eigenvalues: k = {stop} contains all of it",)
    lowest = vectors[:, :k].copy(order="F")
    doubt = pencil.doubts[edge]
    clear = values[stop - 1] < edge - doubt and (stop == len(values) or values[stop] > edge + doubt)
    return measured(
        *(measure(stiffness, mass, lowest, spacing=max(edge, 0.0) / stop), lowest, "dense"),
        inertia=((edge, pencil.counts[edge]),),
        complete=bool(clear) and pencil.counts[edge] == stop,
        notes=notes,
    )


def _whole_cluster(values: Floats, k: int) -> int:
    """Return where the cluster that holds the k-th of the sorted values ends.

    Only as many values are looked at as it takes: slivers bring some of 1e12, beside which all others are equal.
    """
    some = k
    while True:
        some = min(some + k + 8, len(values))
        stop = next((stop for start, stop in clusters(values[:some]) if start < k <= stop), k)
        if stop < some or some == len(values):
            return stop


def factor_above(pencil: ShiftedPencil, values: Floats, count: int) -> float:
    """Factorise in the gap above the first `count` of the sorted values; above all of them, one spacing more.

    Returns
    -------
    float
        The shift, at which the pencil knows its count.
    """
    last = float(values[count - 1])
    beyond = last + 2.0 * max(mean_spacing(values), 1e-3 * abs(last))
    room = 0.5 * ((float(values[count]) if count < len(values) else beyond) - last)
    return pencil.factor(last + room, room=room)[0]


def dense_pairs(stiffness: Floats, mass: Floats, tolerance: float, spacing: float) -> tuple[Floats, Floats]:
    """Find all pairs of a stack of pencils.

    The pencil (B, A) keeps the digits of large eigenvalues; with slivers, whose eigenvalues exceed the first ones 1e10
    times and more, it loses those of small ones. The inverted pencil, (B, A + s B) with s about the first positive
    eigenvalue, keeps them. Where the first alone misses the tolerance, the lowest pairs come from the second, up to the
    seam at which the worst residual and overlap are least.

    Parameters
    ----------
    stiffness, mass : (m, c, c) float64
    tolerance : float
        Largest relative residual.
    spacing : float
        Mean distance of eigenvalues, the scale of residuals near 0.

    Returns
    -------
    values : (m, c) float64
        Increasing.
    vectors : (m, c, c) float64
        B-orthonormal columns.

    Raises
    ------
    EigensolverError
        If a mass is not positive definite.
    """
    values, vectors = _reduced(stiffness, mass)
    late = np.flatnonzero((_residuals(stiffness, mass, values, vectors, spacing) > 0.1 * tolerance).any(axis=1))
    for i in late:
        low_values, low_vectors = _inverted(stiffness[i], mass[i], values[i])
        seam = _best_seam(stiffness[i], mass[i], (low_values, low_vectors), (values[i], vectors[i]), spacing)
        values[i, :seam], vectors[i, :, :seam] = low_values[:seam], low_vectors[:, :seam]
    return values, vectors


def _reduced(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Solve left x = theta right x for stacks, the right sides scaled to unit diagonals; x^T right x = 1."""
    scale = 1.0 / np.sqrt(np.einsum("mii->mi", right))
    scaled = right * scale[:, :, None] * scale[:, None, :]
    try:
        lower = np.linalg.cholesky(scaled)
    except np.linalg.LinAlgError as cause:
        least = float(np.linalg.eigvalsh(scaled).min())
        raise EigensolverError(
            f"the mass matrix is not positive definite, its least eigenvalue at unit diagonal is {least:.1e}: "
            "repair faces of no area or give another mass"
        ) from cause
    half = np.linalg.solve(lower, left * scale[:, :, None] * scale[:, None, :])
    whole = np.linalg.solve(lower, half.transpose(0, 2, 1))
    values, rotated = np.linalg.eigh(0.5 * (whole + whole.transpose(0, 2, 1)))
    return values, np.linalg.solve(lower.transpose(0, 2, 1), rotated) * scale[:, :, None]


def _inverted(stiffness: Floats, mass: Floats, guess: Floats) -> tuple[Floats, Floats]:
    """Solve B x = theta (A + s B) x: the largest theta, the lowest lambda = 1 / theta - s, are the accurate ones."""
    shift = float(np.median(np.abs(guess))) or 1.0
    shift = min(shift, max(4.0 * np.pi / float(mass.sum()), 1e-12 * float(np.abs(guess).max())))
    try:
        theta, vectors = (stack[0, ..., ::-1] for stack in _reduced(mass[None], (stiffness + shift * mass)[None]))
    except EigensolverError:
        return guess, np.full_like(mass, np.nan)
    theta = np.maximum(theta, np.finfo(float).tiny)
    return 1.0 / theta - shift, vectors / np.sqrt(theta)


def _best_seam(
    stiffness: Floats, mass: Floats, low: tuple[Floats, Floats], high: tuple[Floats, Floats], spacing: float
) -> int:
    """Return how many of the lowest pairs to take from the first set, so that those kept are the best together.

    An eigenvalue of multiplicity two has different vectors in the two sets: a seam through it would repeat one of them.
    """
    low_errors, high_errors = (
        _residuals(stiffness[None], mass[None], values[None], vectors[None], spacing)[0]
        for values, vectors in (low, high)
    )
    masses = mass @ high[1]
    with np.errstate(invalid="ignore"):
        low_errors = np.maximum(low_errors, _overlaps_before(np.abs(low[1].T @ (mass @ low[1]))))
        high_errors = np.maximum(high_errors, _overlaps_before(np.abs(high[1].T @ masses)[::-1, ::-1])[::-1])
        across = np.abs(low[1].T @ masses)
    # entry (i, j): the largest overlap of the first i + 1 from below with all but the first j from above
    across = np.maximum.accumulate(np.maximum.accumulate(across, axis=0)[:, ::-1], axis=1)[:, ::-1]
    both = np.concatenate([[0.0], across.diagonal(1), [0.0]])
    below = np.append(0.0, np.maximum.accumulate(low_errors))
    above = np.append(np.maximum.accumulate(high_errors[::-1])[::-1], 0.0)
    return int(np.nan_to_num(np.maximum(np.maximum(below, above), both), nan=np.inf).argmin())


def _overlaps_before(products: Floats) -> Floats:
    """Return the largest entry of each column above the diagonal, infinite where it is not a number."""
    before = np.triu(products, 1).max(axis=0)
    return np.where(np.isfinite(before), before, np.inf)


def _residuals(stiffness: Floats, mass: Floats, values: Floats, vectors: Floats, spacing: float) -> Floats:
    """(m, c) relative residuals; what is not a number counts as infinite."""
    masses = mass @ vectors
    errors = np.linalg.norm(stiffness @ vectors - masses * values[:, None, :], axis=1)
    with np.errstate(invalid="ignore"):
        residuals = errors / np.linalg.norm(masses, axis=1) / np.maximum(np.abs(values), spacing)
    return np.where(np.isfinite(residuals), residuals, np.inf)
