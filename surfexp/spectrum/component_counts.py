"""How many eigenvalues of each component of a pencil lie below a shift, by one factorisation of all of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from surfexp.contract.arrays import Floats, Integers
from surfexp.spectrum.counting_function import guess_eigenvalue
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.shifted_pencil import ShiftedPencil

COUNTING_STEPS = 60
NARROWEST_BRACKET = 1.1
FEW_STEPS = 10


@dataclass(frozen=True, eq=False)
class CountedShift:
    """A shift at which the pivots have counted the eigenvalues of each component.

    Parameters
    ----------
    shift : float
    counts : (c,) int64
        Eigenvalues of each component below the shift.
    doubts : (c,) float64
        How near to the shift an eigenvalue of each has to lie to have been counted on the wrong side.
    """

    shift: float
    counts: Integers
    doubts: Floats

    @property
    def total(self) -> int:
        """Eigenvalues of all components below the shift."""
        return int(self.counts.sum())


def component_labels(stiffness: csr_array, mass: csr_array) -> tuple[int, Integers]:
    """Return how many components the graph of both matrices has, and (n,) the component of each row.

    Stored zeros couple nothing.
    """
    coupling = abs(stiffness) + abs(mass)
    coupling.eliminate_zeros()
    count, labels = connected_components(coupling, directed=False)
    return int(count), labels.astype(np.int64)


def count_at(pencil: ShiftedPencil, labels: Integers, shift: float) -> CountedShift:
    """Factorise at the shift, or near it, and count by the signs of the pivots of each component."""
    shift, factors = pencil.factor(shift)
    owners = labels[pencil.order]
    counts = np.bincount(owners, factors.negative)
    perturbations = np.sqrt(np.bincount(owners, factors.row_errors**2) / np.bincount(owners, factors.row_sizes**2))
    mean_masses = np.bincount(owners, pencil.mass.sum(axis=1)) / np.bincount(owners)
    return CountedShift(shift, counts.astype(np.int64), 10.0 * perturbations / mean_masses)


def counted_shift(pencil: ShiftedPencil, labels: Integers, k: int) -> CountedShift:
    """Find a shift with at least k eigenvalues below it, and few more unless a cluster lies there."""
    area = float(pencil.mass.sum())
    allowed = k + max(8, k // 8) + int(labels.max())
    low, step = 0.0, 2.0
    best: CountedShift | None = None
    for attempt in range(COUNTING_STEPS):
        shift = guess_eigenvalue(k + 0.5 * (allowed - k), area, pencil.counts)
        if best is None:
            shift, step = max(shift, step * low), 1.3 * step
        elif not low < shift < best.shift or attempt > FEW_STEPS // 2:
            shift = float(np.sqrt(low * best.shift)) if low else 0.25 * best.shift
        counted = count_at(pencil, labels, shift)
        if counted.total < k:
            low = max(low, counted.shift)
        elif best is None or counted.shift < best.shift:
            best = counted
        if best is not None and (best.total <= allowed or best.shift < NARROWEST_BRACKET * low or attempt >= FEW_STEPS):
            return best
    raise EigensolverError(
        f"only {counted.total} eigenvalues lie below {counted.shift:.1e}, k = {k} are wanted: the mass or the stiffness "
        "is not that of a surface (is one of them singular?)"
    )
