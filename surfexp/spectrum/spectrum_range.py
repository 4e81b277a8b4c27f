"""Every eigenpair between two bounds, proved by the inertia at shifts just outside of them."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from threadpoolctl import threadpool_limits

from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import LDLT
from surfexp.spectrum.counting_function import guess_eigenvalue
from surfexp.spectrum.eigensolver_error import EigensolverError, SliverError
from surfexp.spectrum.eigensystem import EigenSystem, measure, measured
from surfexp.spectrum.pencil_checks import certified
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.single_slice import solve_where_orthogonal
from surfexp.spectrum.spectrum_slice import SliceRequest

# a shift that the pencil moves away from an eigenvalue stays on its side of a bound
CLEARANCE = 1e-2
SLICE = 250
SHIFT_ATTEMPTS = 8
WIDEST_SHARE = 4
# of the tolerance, for slices: their own estimate of a residual may fall short of what is measured
SHARES = (1.0, 0.05, 0.002)


def pairs_between(
    pencil: ShiftedPencil, low: float, high: float, tolerance: float = 1e-8, seed: int = 0
) -> EigenSystem:
    """Return all pairs with low <= lambda <= high.

    Parameters
    ----------
    pencil : ShiftedPencil
        Its counts are used, and grow.
    low, high : float
    tolerance : float
        Largest relative residual.
    seed : int

    Returns
    -------
    EigenSystem
        `inertia` proves that none is missing; no pair at all is an answer, too. The metric `first_number` counts the
        eigenvalues below the first.

    Raises
    ------
    EigensolverError
        If the bounds are in the wrong order, hold more than a quarter of the spectrum, or the proof fails.
    """
    if not (np.isfinite([low, high]).all() and low < high):
        raise EigensolverError(f"bounds are {low:g} and {high:g}: give two numbers, the lower first")
    with threadpool_limits(1, "blas"):
        bottom, start = _outside(pencil, low, -1.0)
        top, end = _outside(pencil, high, 1.0)
        if WIDEST_SHARE * (end - start) > pencil.size:
            raise EigensolverError(
                f"{end - start} eigenvalues lie between {low:g} and {high:g}, at most a quarter of {pencil.size} are found"
            )
        for share in SHARES:
            values, vectors = _solved(pencil, bottom, start, end, share * tolerance, seed)
            if _largest_residual(pencil, values, vectors, (bottom, top)) <= tolerance:
                break
        if (counted := int(((values > bottom) & (values < top)).sum())) != end - start:
            raise SliverError(
                f"{counted} pairs were found between {bottom:g} and {top:g}, the inertia says {end - start}: "
                "repair slivers, or take other bounds"
            )
        # an eigenvalue is known to its residual alone: one that meets a bound is inside
        below, above = (tolerance * max(abs(bound), _spacing(pencil)) for bound in (low, high))
        chosen = (values >= low - below) & (values <= high + above)
        met = int((chosen & ((np.abs(values - low) <= below) | (np.abs(values - high) <= above))).sum())
        found = _proved(pencil, vectors[:, chosen], (bottom, top), tolerance)
        notes = (f"{met} eigenvalues meet a bound to {tolerance:g} of it and are taken as inside.",) if met else ()
        first = start + int(((values > bottom) & (values < low - below)).sum())
        return replace(found, metrics={**found.metrics, "first_number": float(first)}, notes=(*found.notes, *notes))


def _spacing(pencil: ShiftedPencil) -> float:
    """The mean distance of eigenvalues, by Weyl's law."""
    return 4.0 * np.pi / float(pencil.mass.sum())


def _outside(pencil: ShiftedPencil, bound: float, side: float) -> tuple[float, int]:
    """Return a shift at the bound or beyond it on one side, and how many eigenvalues lie below it."""
    if side < 0 and bound <= 0:
        return -np.inf, 0
    shift = pencil.factor(bound + side * CLEARANCE * max(abs(bound), _spacing(pencil)))[0]
    return shift, pencil.counts[shift]


def _solved(
    pencil: ShiftedPencil, bottom: float, start: int, end: int, tolerance: float, seed: int
) -> tuple[Floats, Floats]:
    """Return the pairs number `start` up to `end`, and perhaps some after them, slice by slice."""
    values, blocks = [np.empty(0)], [np.empty((pencil.size, 0))]
    found, edge = start, bottom
    while found < end:
        count = min(end - found, max(1, min(SLICE, pencil.size // 5)))
        request_at = partial(_request, pencil, edge, found, count, tolerance)
        part = solve_where_orthogonal(pencil, *_shift(pencil, found, count, edge), request_at, seed)
        if not part.complete:
            raise EigensolverError(
                f"{len(part.values)} pairs converged between {edge:g} and {part.edge:g}, which the inertia does not prove "
                "to be all: repair slivers, or take other bounds"
            )
        values.append(part.values)
        blocks.append(part.vectors)
        found, edge = found + len(part.values), part.edge
    return np.concatenate(values), np.concatenate(blocks, axis=1)


def _request(
    pencil: ShiftedPencil, edge: float, found: int, count: int, tolerance: float, shift: float
) -> SliceRequest:
    below = max(pencil.counts[shift] - found, 0)
    return SliceRequest(edge, found, below, max(count - below, 1), 0, tolerance, shift / max(pencil.counts[shift], 1))


def _largest_residual(pencil: ShiftedPencil, values: Floats, vectors: Floats, edges: tuple[float, float]) -> float:
    """Of the pairs between the edges, relative as `_proved` has it."""
    vectors = vectors[:, (values > edges[0]) & (values < edges[1])]
    if not vectors.shape[1]:
        return 0.0
    spacing = abs(edges[1]) / max(pencil.counts[edges[1]], 1)
    return float(measure(pencil.stiffness, pencil.mass, vectors, spacing=spacing).residuals.max())


def _shift(pencil: ShiftedPencil, found: int, count: int, edge: float) -> tuple[float, LDLT]:
    """Factorise where about half of the wanted eigenvalues lie below."""
    area = float(pencil.mass.sum())
    for _ in range(SHIFT_ATTEMPTS):
        guess = guess_eigenvalue(found + 0.5 * count, area, pencil.counts)
        if found:
            guess = max(guess, edge + 1e-3 * abs(edge))
        shift, factors = pencil.factor(guess)
        if shift > edge and 0.2 * count <= pencil.counts[shift] - found <= 0.8 * count + 1:
            break
    return shift, factors


def _proved(pencil: ShiftedPencil, vectors: Floats, edges: tuple[float, float], tolerance: float) -> EigenSystem:
    inertia = tuple((edge, pencil.counts[edge]) for edge in edges if np.isfinite(edge))
    if not vectors.shape[1]:
        return EigenSystem(np.empty(0), vectors, np.empty(0), 0.0, True, inertia, method="slicing")
    top, number = inertia[-1]
    measurement = measure(pencil.stiffness, pencil.mass, vectors, spacing=abs(top) / max(number, 1))
    ordered = np.empty_like(vectors, order="F")
    ordered[pencil.order] = vectors
    found = measured(measurement, ordered, "slicing", inertia, complete=True)
    return certified(found, vectors.shape[1], tolerance)
