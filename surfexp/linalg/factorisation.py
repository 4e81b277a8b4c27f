"""Factorise a symmetric positive definite sparse matrix once, solve with it many times."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import cholespy
import numpy as np
from scipy.sparse import csc_array, sparray
from scipy.sparse.linalg import splu

from surfexp.contract.arrays import Floats

RESIDUAL_LIMIT = 1e-11


class Solve(Protocol):
    """The triangular solves of one factorisation."""

    def __call__(self, right_hand_side: Floats) -> Floats:
        """Return the solution for an (n,) or (n, c) right-hand side."""
        ...


@dataclass(frozen=True, eq=False)
class Factorisation:
    """A factorised matrix.

    Parameters
    ----------
    backend : {"cholespy", "superlu"}
    size : int
    residual : float
        Backward error |A x - b| / (|A| |x| + |b|) of a first solve, in the maximum norm.
    triangular_solves : Solve
    """

    backend: str
    size: int
    residual: float
    triangular_solves: Solve

    def solve(self, right_hand_side: Floats) -> Floats:
        """Return x with A x = b for an (n,) or (n, c) right-hand side.

        Raises
        ------
        ValueError
            If the lengths differ.
        """
        if len(right_hand_side) != self.size:
            raise ValueError(f"right-hand side has {len(right_hand_side)} rows, the matrix has {self.size}")
        return self.triangular_solves(np.ascontiguousarray(right_hand_side, dtype=np.float64))


def factorise(matrix: sparray) -> Factorisation:
    """Factorise a symmetric positive definite matrix: Cholesky first, SuperLU when that fails or solves badly.

    The residual of a first solve, with a fixed right-hand side, is checked before anybody relies on the factors.

    Parameters
    ----------
    matrix : (n, n) sparse array

    Returns
    -------
    Factorisation

    Raises
    ------
    ValueError
        If the matrix is not square, has entries that are not finite, or neither factorisation solves with it.
    """
    compressed = csc_array(matrix, dtype=np.float64)
    compressed.sum_duplicates()
    rows, columns = compressed.shape
    if rows != columns:
        raise ValueError(f"matrix has shape {rows} x {columns}, a factorisation needs a square one")
    if not np.isfinite(compressed.data).all():
        raise ValueError(f"matrix has {int((~np.isfinite(compressed.data)).sum())} entries that are not finite")
    probe = np.cos(np.arange(rows, dtype=np.float64))
    failures = []
    for backend, prepare in (("cholespy", _cholespy), ("superlu", _superlu)):
        try:
            solve = prepare(compressed)
            residual = _backward_error(compressed, solve(probe), probe)
        except (RuntimeError, ValueError) as error:
            failures.append(f"{backend}: {error}")
            continue
        if residual <= RESIDUAL_LIMIT:
            return Factorisation(backend, rows, residual, solve)
        failures.append(f"{backend}: residual {residual:.1e}, at most {RESIDUAL_LIMIT:.0e} is accepted")
    raise ValueError(f"no factorisation solves with this {rows} x {rows} matrix ({'; '.join(failures)})")


def _backward_error(matrix: csc_array, solution: Floats, right_hand_side: Floats) -> float:
    size = float(abs(matrix).sum(axis=1).max() * np.abs(solution).max() + np.abs(right_hand_side).max())
    return float(np.abs(matrix @ solution - right_hand_side).max() / size)


def _cholespy(matrix: csc_array) -> Solve:
    if matrix.diagonal().min() <= 0.0:  # cholespy writes beyond its arrays when entries of the diagonal are missing
        raise ValueError("not positive definite")
    solver = cholespy.CholeskySolverD(
        matrix.shape[0],
        matrix.indptr.astype(np.int32),
        matrix.indices.astype(np.int32),
        matrix.data,
        cholespy.MatrixType.CSC,
    )

    def solve(right_hand_side: Floats) -> Floats:
        solution = np.zeros_like(right_hand_side)
        solver.solve(right_hand_side, solution)
        return solution

    return solve


def _superlu(matrix: csc_array) -> Solve:
    solve: Solve = splu(matrix).solve
    return solve
