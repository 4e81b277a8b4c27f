"""A pencil that falls apart: every connected component is solved by itself, and one factorisation of all counts them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.spectrum.component_counts import CountedShift, count_at, counted_shift
from surfexp.spectrum.dense import LARGEST_DENSE_SIZE, dense_pairs
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.eigensystem import SMALLEST_GAP, EigenSystem, measure, measured
from surfexp.spectrum.shifted_pencil import ShiftedPencil

DENSE_ENTRIES = 4_000_000
SHIFT_MOVES, SHIFT_STEP = 4, 1.003


Solver = Callable[[csr_array, csr_array, int], EigenSystem]


@dataclass(frozen=True, eq=False)
class ComponentPairs:
    """The pairs of one component that lie below a shift.

    Parameters
    ----------
    component : int
    rows : (c,) int64
        Its rows in the whole pencil.
    values : (p,) float64
    vectors : (c, p) float64
    above : float
        The next eigenvalue, infinite where it was not computed.
    complete : bool
        Whether the solver of the component proves them its lowest.
    method : str
        That solver.
    """

    component: int
    rows: Integers
    values: Floats
    vectors: Floats
    above: float
    complete: bool
    method: str


def solve_components(
    stiffness: csr_array,
    mass: csr_array,
    labels: Integers,
    k: int,
    solve: Solver,
    dense_size: int,
    tolerance: float = 1e-8,
) -> EigenSystem:
    """Find the k lowest pairs of a block diagonal pencil; equal and nearly equal copies meet only when values are sorted.

    The inertia of A - s B, at a shift s that at least k eigenvalues lie below, is that of its components side by side: the
    signs of the pivots say how many pairs each component owes. Components of up to `dense_size` rows, or that owe over a
    quarter of their pairs, are solved in stacks of equal size by dense algebra, others by `solve`.

    Parameters
    ----------
    stiffness, mass : (n, n) csr_array
    labels : (n,) int64
        Component of each row.
    k : int
    solve : callable
        Returns the lowest pairs of one component: (stiffness, mass, count) to `EigenSystem`.
    dense_size : int
    tolerance : float

    Returns
    -------
    EigenSystem
        Complete where each component has delivered exactly the pairs that it owes, all clearly below s.
    """
    pencil = ShiftedPencil(stiffness, mass)
    counted = counted_shift(pencil, labels, k)
    for _ in range(SHIFT_MOVES):
        parts = _lowest_of_each(stiffness, mass, labels, counted, solve, dense_size, tolerance)
        delivered = _all_delivered(parts, counted)
        if delivered:
            break
        counted = count_at(pencil, labels, SHIFT_STEP * counted.shift)
    spacing = counted.shift / max(counted.total, 1)
    values, vectors = _merged(parts, k, len(labels))
    methods = {part.method for part in parts} - {"dense"}
    return measured(
        *(measure(stiffness, mass, vectors, spacing=spacing), vectors, methods.pop() if methods else "dense"),
        inertia=((counted.shift, counted.total),),
        complete=delivered and len(values) >= k,
        metrics={"factorisations": float(len(pencil.counts)), "components": float(len(counted.counts))},
        notes=_cluster_note(values, k, spacing),
    )


def _lowest_of_each(
    stiffness: csr_array,
    mass: csr_array,
    labels: Integers,
    counted: CountedShift,
    solve: Solver,
    dense_size: int,
    tolerance: float,
) -> list[ComponentPairs]:
    """Return the pairs of every component that owes some."""
    sizes = np.bincount(labels)
    order = np.argsort(labels, kind="stable")
    starts = np.concatenate([[0], np.cumsum(sizes)])
    owing = counted.counts > 0
    small = owing & ((sizes <= dense_size) | ((4 * counted.counts > sizes) & (sizes <= LARGEST_DENSE_SIZE)))
    spacing = counted.shift / max(counted.total, 1)
    local = np.empty(len(labels), np.int64)
    local[order] = np.arange(len(labels)) - np.repeat(starts[:-1], sizes)
    parts = []
    for size in np.unique(sizes[small]):
        members = np.flatnonzero(small & (sizes == size))
        for chunk in np.array_split(members, int(np.ceil(len(members) * size**2 / DENSE_ENTRIES))):
            energies = _dense_blocks(stiffness, labels, local, chunk, int(size))
            masses = _dense_blocks(mass, labels, local, chunk, int(size))
            values, vectors = dense_pairs(energies, masses, tolerance, spacing)
            for i, member in enumerate(chunk):
                rows, owed = order[starts[member] : starts[member + 1]], int(counted.counts[member])
                above = float(values[i, owed]) if owed < size else np.inf
                parts.append(
                    ComponentPairs(int(member), rows, values[i, :owed], vectors[i, :, :owed], above, True, "dense")
                )
    for member in np.flatnonzero(owing & ~small):
        rows, owed = order[starts[member] : starts[member + 1]], int(counted.counts[member])
        try:
            system = solve(csr_array(stiffness[rows][:, rows]), csr_array(mass[rows][:, rows]), owed)
        except EigensolverError as cause:
            raise type(cause)(f"component {member} of {len(sizes)} ({len(rows)} rows): {cause}") from cause
        parts.append(
            ComponentPairs(int(member), rows, system.values, system.vectors, np.inf, system.complete, system.method)
        )
    return parts


def _dense_blocks(matrix: csr_array, labels: Integers, local: Integers, members: Integers, size: int) -> Floats:
    """(len(members), size, size) dense matrices of some components, `local` being the place of a row in its own."""
    slots = np.full(int(labels.max()) + 1, -1)
    slots[members] = np.arange(len(members))
    entries = matrix.tocoo()
    slot = slots[labels[entries.row]]
    kept = (slot >= 0) & (slot == slots[labels[entries.col]])
    blocks = np.zeros((len(members), size, size))
    blocks[slot[kept], local[entries.row[kept]], local[entries.col[kept]]] = entries.data[kept]
    return blocks


def _all_delivered(parts: list[ComponentPairs], counted: CountedShift) -> bool:
    """Whether each component has as many pairs below the shift as its pivots say, none of them in doubt."""
    delivered = np.zeros(len(counted.counts), np.int64)
    for part in parts:
        doubt = counted.doubts[part.component]
        clear = part.complete and part.values.max(initial=-np.inf) < counted.shift - doubt
        if clear and part.above > counted.shift + doubt:
            delivered[part.component] = len(part.values)
    return bool((delivered == counted.counts).all())


def _merged(parts: list[ComponentPairs], k: int, size: int) -> tuple[Floats, Floats]:
    """Return all values, sorted, and (n, k) the vectors of the k lowest, each 0 outside its component."""
    values = np.concatenate([part.values for part in parts])
    ranks = np.empty(len(values), np.int64)
    ranks[np.argsort(values, kind="stable")] = np.arange(len(values))
    vectors = np.zeros((size, min(k, len(values))), order="F")
    first = 0
    for part in parts:
        columns = ranks[first : first + len(part.values)]
        first += len(part.values)
        chosen = np.flatnonzero(columns < k)
        vectors[part.rows[:, None], columns[chosen]] = part.vectors[:, chosen]
    return np.sort(values), vectors


def _cluster_note(values: Floats, k: int, spacing: float) -> tuple[str, ...]:
    gaps = np.diff(values) > SMALLEST_GAP * np.maximum(np.abs(values[1:]), spacing)
    stop = k + int(np.argmax(np.append(gaps[k - 1 :], True)))
    return (f"k = {k} cuts a cluster of nearly equal eigenvalues: k = {stop} contains all of it",) if stop > k else ()
