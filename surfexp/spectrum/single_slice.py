"""One slice of a spectrum: a shift with about half of the wanted eigenvalues below it, then the pairs on both sides."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from surfexp.linalg.ldlt import LDLT
from surfexp.spectrum.counting_function import guess_eigenvalue
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.spectrum_slice import SliceRequest, SpectrumSlice, solve_slice

# few pairs are found soonest from their middle, many from above it
FIRST_SHIFT, INNER_SHIFT, FEW = 0.6, 0.5, 60
SHIFT_ATTEMPTS = 12
# what rounding leaves of a shift grows with the rows, 4e-16 to 1.5e-15 of it for each where no eigenvalue is near
SOLVE_ACCURACY, SOLVE_ACCURACY_PER_ROW = 2e-10, 2e-15
# beyond this loss of orthogonality Ritz values are no longer those of the pencil to working accuracy
LARGEST_DRIFT, SHIFT_STEP, SHIFT_MOVES = 1e-6, 0.37, 4

Progress = Callable[[int, float], None]


def solve_at_good_shift(
    pencil: ShiftedPencil,
    found: int,
    count: int,
    freedom: int,
    low: float,
    tolerance: float,
    seed: int,
    edge: float = np.inf,
) -> SpectrumSlice:
    """Solve a slice; where orthogonality was lost, as beside an eigenvalue of high multiplicity, move the shift.

    Parameters
    ----------
    pencil : ShiftedPencil
    found : int
        How many eigenvalues lie below the lower edge.
    count : int
        How many are wanted above it; exactly those below the upper edge, where that is given.
    freedom, low, tolerance, edge
        As in `SliceRequest`.
    seed : int

    Returns
    -------
    SpectrumSlice
    """

    def request_at(shift: float) -> SliceRequest:
        below = pencil.counts[shift] - found
        return SliceRequest(
            low=low,
            start=found,
            below=below,
            above=max(count - below, 1),
            freedom=freedom,
            tolerance=tolerance,
            spacing=shift / max(pencil.counts[shift], 1),
            edge=edge,
        )

    return solve_where_orthogonal(pencil, *_choose_shift(pencil, found, count, low), request_at, seed)


def solve_where_orthogonal(
    pencil: ShiftedPencil, shift: float, factors: LDLT, request_at: Callable[[float], SliceRequest], seed: int
) -> SpectrumSlice:
    """Solve a slice around a shift, which is moved where orthogonality was lost.

    Parameters
    ----------
    pencil : ShiftedPencil
    shift : float
    factors : LDLT
        Of the shift.
    request_at : callable
        What is asked for around a shift.
    seed : int

    Returns
    -------
    SpectrumSlice
    """
    for _ in range(SHIFT_MOVES):
        request = request_at(shift)
        part = solve_slice(pencil, shift, factors, request, seed)
        if part.drift < LARGEST_DRIFT:
            break
        shift, factors = pencil.factor(shift + SHIFT_STEP * request.spacing, solve_accuracy(pencil.size))
    return part


def solve_accuracy(size: int) -> float:
    """Return the doubt, relative to a shift, with which the factors of a pencil with `size` rows are good enough for a slice."""
    return max(SOLVE_ACCURACY, SOLVE_ACCURACY_PER_ROW * size)


def _choose_shift(pencil: ShiftedPencil, found: int, count: int, low: float) -> tuple[float, LDLT]:
    """Factorise at a shift that has 35 % to 75 % of the wanted eigenvalues below it."""
    area = float(pencil.mass.sum())
    fraction = FIRST_SHIFT if low == -np.inf and count > FEW else INNER_SHIFT
    for _ in range(SHIFT_ATTEMPTS):
        guess = guess_eigenvalue(found + fraction * count, area, pencil.counts)
        wanted = max(guess, low + 1e-3 * abs(low)) if found else guess
        shift, factors = pencil.factor(wanted, solve_accuracy(pencil.size))
        below = pencil.counts[shift] - found
        if 0.35 * count <= below <= 0.75 * count:
            break
    return shift, factors
