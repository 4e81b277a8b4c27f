"""Slices of a spectrum side by side: the edges between them are placed and counted first, so that none waits for another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.contract.threads import in_threads
from surfexp.spectrum.counting_function import guess_eigenvalue
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.single_slice import Progress, solve_at_good_shift
from surfexp.spectrum.spectrum_slice import SpectrumSlice

# up to so many pairs one slice is soonest, also where a second core would help
ALONE, PAIRS_OF_A_SLICE = 200, 150
EDGE_ATTEMPTS, EDGE_FREEDOM = 4, 0.15
# of the tolerance: vectors on both sides of an edge are orthogonal only as far as they have converged
SHARE = 0.1


def slices_side_by_side(
    pencil: ShiftedPencil, k: int, tolerance: float, seed: int, threads: int, progress: Progress | None = None
) -> list[SpectrumSlice]:
    """Find the k lowest pairs in slices of about 150 that know both their edges, the last one but the upper.

    Number, edges, shifts and seeds of the slices follow from the pencil and k alone: the result has the same bytes for any
    number of threads.

    Parameters
    ----------
    pencil : ShiftedPencil
        Its counts grow.
    k : int
    tolerance : float
        Largest relative residual.
    seed : int
    threads : int
        How many slices at a time; each has factors and a basis of its own.
    progress : callable, optional
        Receives the number of pairs found and the fraction that is still missing.

    Returns
    -------
    list of SpectrumSlice
        Complete only where the edges leave no doubt on either side.

    Raises
    ------
    EigensolverError
        If no shift factorises well.
    """
    number = int(np.ceil(k / PAIRS_OF_A_SLICE))
    edges = _edges(pencil, [k * i // number for i in range(1, number)], k / number, threads)
    lows = [(-np.inf, 0), *((edge, pencil.counts[edge]) for edge in edges)]
    # the last slice looks for a gap above k, as one alone does
    highs = [*((edge, pencil.counts[edge]) for edge in edges), (np.inf, k)]

    # made before the first slice ends, so that no slice knows the counts of another
    pencils = [pencil.with_own_factors() for _ in lows]

    def solved(place: int) -> tuple[SpectrumSlice, ShiftedPencil]:
        own, (low, start), (high, stop) = pencils[place], lows[place], highs[place]
        part = solve_at_good_shift(own, start, stop - start, 0, low, SHARE * tolerance, seed + place, high)
        certain = not start or (len(part.values) > 0 and float(part.values[0]) - low > own.doubts[low])
        return replace(part, complete=part.complete and certain), own

    slices: list[SpectrumSlice] = []
    found = 0
    for part, own in in_threads(solved, range(len(lows)), threads):
        slices.append(part)
        pencil.counts.update(own.counts)
        pencil.doubts.update(own.doubts)
        found += len(part.values)
        if progress is not None:
            progress(found, max(0.0, 1.0 - found / k))
    return slices


def _edges(pencil: ShiftedPencil, numbers: list[int], width: float, threads: int) -> list[float]:
    """Return increasing shifts that about the given numbers of eigenvalues lie below."""
    area = float(pencil.mass.sum())

    def placed(given: tuple[ShiftedPencil, int]) -> tuple[float, ShiftedPencil]:
        own, number = given
        for _ in range(EDGE_ATTEMPTS):
            edge = own.factor(guess_eigenvalue(number, area, own.counts))[0]
            if abs(own.counts[edge] - number) <= EDGE_FREEDOM * width:
                break
        return edge, own

    # the highest tells the others how far Weyl's law is off here
    edges = [placed((pencil, numbers[-1]))[0]]
    others = [(pencil.with_own_factors(), number) for number in numbers[:-1]]
    for edge, own in in_threads(placed, others, threads):
        edges.append(edge)
        pencil.counts.update(own.counts)
        pencil.doubts.update(own.doubts)
    edges.sort()
    # edges with nothing between them are one
    return [edge for i, edge in enumerate(edges) if not i or pencil.counts[edge] > pencil.counts[edges[i - 1]]]
