"""All eigenpairs around one shift, up to an edge whose inertia proves that none is missing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.linalg.block_lanczos import BLOCK, BlockLanczos
from surfexp.linalg.ldlt import LDLT
from surfexp.spectrum.eigensystem import SMALLEST_GAP
from surfexp.spectrum.shifted_pencil import ShiftedPencil

RESTARTS = 30
# an edge lies in a gap of at least so many mean spacings, where the pencil can be factorised well
EDGE_GAP = 0.02


@dataclass(frozen=True)
class SliceRequest:
    """What one slice has to deliver.

    Parameters
    ----------
    low : float
        Lower edge; the pairs below it are known already, or there are none.
    start : int
        How many eigenvalues lie below the lower edge.
    below : int
        How many lie between the lower edge and the shift, by inertia.
    above : int
        How many of those above the shift are wanted, at least.
    freedom : int
        How many fewer than `above` will do where a larger gap lies there.
    tolerance : float
        Relative residual of a pair.
    spacing : float
        Mean distance of eigenvalues, the scale of the tolerance near 0.
    edge : float
        Upper edge, factorised already, below which `below` and `above` are all; infinite where one is to be found.
    """

    low: float
    start: int
    below: int
    above: int
    freedom: int
    tolerance: float
    spacing: float
    edge: float = np.inf


@dataclass(frozen=True, eq=False)
class SpectrumSlice:
    """Pairs between two edges by increasing value, in elimination order, and how they were won."""

    values: Floats
    vectors: Floats
    edge: float
    complete: bool
    basis_size: int
    drift: float


def solve_slice(pencil: ShiftedPencil, shift: float, factors: LDLT, request: SliceRequest, seed: int) -> SpectrumSlice:
    """Find every eigenpair between the lower edge and the given upper edge, or one in a gap above the shift.

    Block Lanczos runs until the pairs below the shift are as many as the inertia says and enough above have converged.
    An upper edge that is not given is put into a gap, the pencil factorised there, and its count compared. Where pairs are
    missing (copies beyond the block size of an eigenvalue of high multiplicity), Lanczos starts again, orthogonally to those
    found.
    """
    values, vectors = np.empty(0), np.empty((pencil.size, 0), order="F")
    edge, expected, basis_size, drift = request.edge, request.below + request.above, 0, 0.0
    for attempt in range(RESTARTS):
        if attempt:
            factors = pencil.factor(shift)[1]
        # more pairs than expected may have come where no gap has been found for the edge yet
        missing = max(expected - len(values), 0)
        capacity = min(int(4.5 * missing) + 20 * BLOCK, pencil.size - len(values)) // BLOCK * BLOCK
        if not capacity:
            break
        lanczos = BlockLanczos(
            *(
                factors.solve_in_order,
                pencil.multiply_mass,
                pencil.size,
                capacity,
                vectors,
                seed + attempt,
            )
        )
        new_values, new_vectors = _iterate(lanczos, shift, edge, expected, request, values)
        values, vectors = merge(values, vectors, new_values, new_vectors)
        basis_size, drift = basis_size + lanczos.dimension, max(drift, lanczos.drift)
        if edge == np.inf:
            split = upper_edge(values, shift, request)
            if split:
                below, above = float(values[split - 1]), float(values[split])
                edge = pencil.factor(0.5 * (below + above), room=0.5 * (above - below))[0]
                expected = pencil.counts[edge] - request.start
                values, vectors = values[:split], vectors[:, :split]
        if (edge < np.inf and len(values) >= expected) or not len(new_values):
            break
    complete = 0 < len(values) == expected and edge < np.inf and edge - values[-1] > pencil.doubts[edge]
    return SpectrumSlice(values, vectors, edge, complete, basis_size, drift)


def merge(values: Floats, vectors: Floats, new_values: Floats, new_vectors: Floats) -> tuple[Floats, Floats]:
    """Return both sets of pairs by increasing value; the second set is sorted already."""
    if not len(values):
        return new_values, new_vectors
    together = np.concatenate([values, new_values])
    order = np.argsort(together, kind="stable")
    return together[order], np.asfortranarray(np.concatenate([vectors, new_vectors], axis=1)[:, order])


def upper_edge(values: Floats, shift: float, request: SliceRequest) -> int:
    """Return how many of the sorted converged values to keep, so that a gap follows; 0 where there is none yet.

    The largest gap is taken among those that `freedom` allows; without it, the first that is wide enough for an edge.
    """
    wanted = int((values < shift).sum()) + request.above
    first = max(1, wanted - request.freedom)
    if request.freedom:
        gaps = np.diff(values) / np.maximum(np.abs(values[1:]), request.spacing)
        return first + int(np.argmax(gaps[first - 1 : wanted])) if len(values) > wanted else 0
    chosen = np.flatnonzero(open_gaps(values, request.spacing)[first - 1 :])
    return first + int(chosen[0]) if len(chosen) else 0


def open_gaps(values: Floats, spacing: float) -> NDArray[np.bool_]:
    """Return for each value but the last of a sorted spectrum whether an edge may follow it."""
    scales = np.maximum(np.abs(values[1:]), spacing)
    return np.asarray(np.diff(values) > np.maximum(SMALLEST_GAP * scales, EDGE_GAP * spacing))


def _iterate(
    lanczos: BlockLanczos, shift: float, edge: float, expected: int, request: SliceRequest, known: Floats
) -> tuple[Floats, Floats]:
    """Grow the basis until the slice is full or nothing more comes; return the converged pairs inside the slice.

    Nothing more comes when pairs are missing where none is on its way: all that Lanczos sees there has converged.
    """
    missing = expected - len(known)
    share = 1.55 if request.low == -np.inf else 1.8 if request.edge == np.inf else 2.3
    next_look = int(share * missing) + 5 * BLOCK
    before = -1
    while True:
        lanczos.extend()
        if lanczos.dimension < min(next_look, lanczos.capacity - BLOCK + 1):
            continue
        ritz = lanczos.ritz()
        with np.errstate(divide="ignore"):
            values = shift + 1.0 / ritz.values
            errors = ritz.residuals / ritz.values**2 / np.maximum(np.abs(values), request.spacing)
        good = errors < 0.5 * request.tolerance
        top = min(edge, _converged_reach(values, good, shift))
        chosen = np.flatnonzero(good & (values > request.low) & (values < top))
        chosen = chosen[np.argsort(values[chosen])]
        merged = np.sort(np.concatenate([known, values[chosen]]))
        if edge < np.inf:
            window, short = edge, len(merged) < expected
        else:
            window, short = shift, int((merged < shift).sum()) < request.below
        settled = not (~good & (values > request.low) & (values < window)).any()
        full = lanczos.dimension + BLOCK > lanczos.capacity
        enough = not short and (edge < np.inf or bool(upper_edge(merged, shift, request)))
        if enough or full or (short and settled and len(chosen) == before):
            return values[chosen], lanczos.vectors(ritz, chosen)
        before = len(chosen)
        next_look = lanczos.dimension + max(BLOCK, int(0.06 * missing) // BLOCK * BLOCK)


def _converged_reach(values: Floats, good: NDArray[np.bool_], shift: float) -> float:
    """Return the smallest value above the shift that has not converged: below it, nothing is in doubt."""
    doubtful = values[~good & (values > shift)]
    return float(doubtful.min()) if len(doubtful) else np.inf
