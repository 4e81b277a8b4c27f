"""Spectrum slicing: the k lowest eigenpairs, slice by slice, each certified by inertia."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import sparray
from threadpoolctl import threadpool_limits

from surfexp.contract.arrays import Floats
from surfexp.linalg.block_lanczos import BLOCK
from surfexp.linalg.ldlt import LDLT
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.eigensystem import EigenSystem, Measurement, mean_spacing, measure, measured
from surfexp.spectrum.pencil_checks import certified
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.side_by_side import ALONE, slices_side_by_side
from surfexp.spectrum.single_slice import Progress, solve_at_good_shift
from surfexp.spectrum.spectrum_slice import EDGE_GAP, SpectrumSlice, open_gaps

SLICE = 350
POLISHES = 3


def slicing(
    stiffness: sparray,
    mass: sparray,
    k: int,
    tolerance: float = 1e-8,
    seed: int = 0,
    progress: Progress | None = None,
    threads: int = 1,
) -> EigenSystem:
    """Find the k lowest eigenpairs by block Lanczos at interior shifts (Grimes, Lewis and Simon 1994).

    The first shift lies at about 0.6 lambda_k (or of the last value of the first slice; at half of it for few pairs), so
    that the wanted values are the extreme ones of the inverted operator on both sides. A slice ends in a gap of the
    spectrum, where the inertia of A - s B counts what lies below.

    More than 200 pairs are found in slices side by side, up to `threads` at a time. Where these leave something unproved,
    as at an edge inside a cluster, slices follow one after another, each from the gap in which the last has ended.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse arrays
        Symmetric, the mass positive definite.
    k : int
    tolerance : float
        Largest relative residual, as `EigenSystem.residuals` defines it.
    seed : int
    progress : callable, optional
        Receives the number of pairs found and the fraction that is still missing.
    threads : int
        The result has the same bytes for any number of them.

    Returns
    -------
    EigenSystem

    Raises
    ------
    ValueError
        If no shift factorises well.
    """
    # products of blocks of eight columns are too small for two threads, which wait for each other for longer
    with threadpool_limits(1, "blas"):
        pencil = ShiftedPencil(stiffness, mass)
        if k > ALONE:
            try:
                parts = slices_side_by_side(pencil, k, tolerance, seed, threads, progress)
                return certified(_assemble(pencil, k, tolerance, parts, threads), k, tolerance)
            except EigensolverError:
                pass
        return _assemble(pencil, k, tolerance, _slices(pencil, k, tolerance, seed, progress), threads)


def _slices(
    pencil: ShiftedPencil, k: int, tolerance: float, seed: int, progress: Progress | None
) -> list[SpectrumSlice]:
    """Return slices from the lowest on until they hold k pairs or one is not complete."""
    slices: list[SpectrumSlice] = []
    found, low = 0, -np.inf
    while found < k:
        remaining = k - found
        count = int(np.ceil(remaining / np.ceil(remaining / min(SLICE, pencil.size // 5))))
        freedom = 0 if count == remaining else count // 4
        part = solve_at_good_shift(pencil, found, count, freedom, low, tolerance, seed)
        slices.append(part)
        found, low = found + len(part.values), part.edge
        if progress is not None:
            progress(found, max(0.0, 1.0 - found / k))
        if not part.complete or not len(part.values):
            break
    return slices


def _assemble(
    pencil: ShiftedPencil,
    k: int,
    tolerance: float,
    slices: list[SpectrumSlice],
    threads: int,
) -> EigenSystem:
    values = np.concatenate([part.values for part in slices])
    vectors = np.concatenate([part.vectors for part in slices], axis=1) if len(slices) > 1 else slices[0].vectors
    total = len(values)
    edges = [part.edge for part in slices if part.edge < np.inf]
    spacing = max(edges[-1], 0.0) / max(pencil.counts[edges[-1]], 1) if edges else 0.0
    # before a cluster is cut: its parts alone would not span what inverse iteration keeps
    measurement, polishes = polish(pencil, vectors, tolerance, spacing, threads)
    notes = _notes(measurement.values, k, spacing or measurement.spacing, slices)
    if total > k:
        lowest = np.argsort(measurement.values, kind="stable")[:k]
        in_order = bool((lowest == np.arange(k)).all())
        vectors = vectors[:, :k] if in_order else np.asfortranarray(vectors[:, lowest])
        measurement = measurement.of(lowest)
    for column in vectors.T:
        column[pencil.order] = column.copy()
    complete = all(part.complete for part in slices) and total >= k
    return measured(
        *(measurement, vectors, "slicing"),
        inertia=tuple((edge, pencil.counts[edge]) for edge in edges),
        complete=complete,
        metrics={
            "factorisations": float(len(pencil.counts)),
            "factor_entries_per_row": pencil.symbolic.entries / pencil.size,
            "basis_size": float(sum(part.basis_size for part in slices)),
            "slices": float(len(slices)),
            "polishes": float(polishes),
        },
        notes=notes,
    )


def _notes(values: Floats, k: int, spacing: float, slices: list[SpectrumSlice]) -> tuple[str, ...]:
    notes, total = [], len(values)
    if total > k and not open_gaps(np.sort(values), spacing)[k - 1]:
        notes.append(f"k = {k} cuts a cluster of nearly equal eigenvalues: k = {total} contains all of it")
    for part in slices:
        if not part.complete:
            notes.append(f"the slice below {part.edge:g} is not complete: {len(part.values)} pairs converged")
    return tuple(notes)


def polish(
    pencil: ShiftedPencil, vectors: Floats, tolerance: float, spacing: float = 0.0, threads: int = 1
) -> tuple[Measurement, int]:
    """Improve, in place, the lowest pairs while some miss the tolerance; return the measurement and how often.

    They are the farthest from the shift and, relative to their own size, the least accurate: one block inverse iteration
    just below 0 and a Rayleigh-Ritz step mend them.
    """
    measurement = measure(pencil.stiffness, pencil.mass, vectors, spacing=spacing, threads=threads)
    factors = None
    for done in range(POLISHES):
        bad = np.flatnonzero(measurement.residuals > tolerance)
        if not len(bad):
            return measurement, done
        if factors is None:
            factors = pencil.factor(-0.5 * measurement.spacing)[1]
        count = _before_a_gap(measurement.values, (int(bad[-1]) // BLOCK + 2) * BLOCK)
        improved = inverse_iteration(pencil, factors, vectors[:, :count])
        projected = improved.T @ (pencil.stiffness @ np.ascontiguousarray(improved))
        gram = improved.T @ pencil.multiply_mass(improved)
        try:
            rotation = eigh(0.5 * (projected + projected.T), 0.5 * (gram + gram.T))[1]
        except np.linalg.LinAlgError:
            # dependent vectors, which no rotation repairs: the residuals that stay behind refuse them
            return measurement, done
        vectors[:, :count] = improved @ rotation
        improved_part = measure(pencil.stiffness, pencil.mass, vectors, count, measurement.spacing, threads)
        measurement = improved_part.followed_by(measurement)
    return measurement, POLISHES


def _before_a_gap(values: Floats, count: int) -> int:
    """At least `count`, so that no cluster is cut."""
    spacing = mean_spacing(values)
    while count < len(values) and values[count] - values[count - 1] < EDGE_GAP * spacing:
        count += 1
    return min(count, len(values))


def inverse_iteration(pencil: ShiftedPencil, factors: LDLT, vectors: Floats) -> Floats:
    """Return (A - s B)^-1 B X with columns of length 1."""
    result = np.empty_like(vectors, order="F")
    for first in range(0, vectors.shape[1], BLOCK):
        some = slice(first, min(first + BLOCK, vectors.shape[1]))
        block = np.zeros((pencil.size, BLOCK))
        block[:, : some.stop - first] = pencil.multiply_mass(vectors[:, some])
        factors.solve_in_order(block)
        result[:, some] = block[:, : some.stop - first]
    return np.asarray(result / np.linalg.norm(result, axis=0))
