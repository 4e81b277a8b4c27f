"""Sparse LDL^T of a folded cortex: factors, new factors of the same pattern, solves with one and eight right-hand sides."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import numpy as np
from scipy.sparse import csc_array, csr_array, triu
from scipy.sparse.linalg import splu

from audits.benchmarks.line import Line, not_installed, race
from audits.benchmarks.measurement import measure_both
from audits.benchmarks.scenes import cortex_scene
from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem

LEAST = 1.0
Solve = Callable[[Floats], Floats]


def warm_up() -> None:
    """Compile what the lines use."""
    matrix = _matrix(icosphere(2).mesh)
    factor = ldlt(matrix)
    factor.refactor(matrix)
    factor.solve(np.ones((matrix.shape[0], 8)))
    factor.solve(np.ones(matrix.shape[0]))


def lines(quick: bool) -> list[Line]:
    """Return the lines of every rival."""
    matrix = _matrix(cortex_scene(10000 if quick else 39994).surface.mesh)
    return [line for rival, (package, make) in RIVALS.items() for line in _lines(matrix, rival, package, make)]


def _lines(matrix: csr_array, rival: str, package: str, make: Callable[[csr_array], Callable[[], Solve]]) -> list[Line]:
    size = matrix.shape[0]
    works = {
        "factor": f"stiffness + mass, {size:,} V, analysed and factorised",
        "one": f"stiffness + mass, {size:,} V, one right-hand side",
        "eight": f"stiffness + mass, {size:,} V, eight right-hand sides",
    }
    if find_spec(package) is None:
        return [not_installed(work, rival, LEAST, package) for work in works.values()]
    factorise = make(matrix)
    (ours, cost), (theirs, their_cost) = measure_both(lambda: ldlt(matrix).solve, factorise, runs=5)
    loads = {"one": np.cos(np.arange(size)), "eight": np.cos(np.outer(np.arange(size), np.arange(1.0, 9.0)))}
    accuracy, fair = _accuracy(matrix, ours, theirs, loads["eight"])
    found = [race(works["factor"], rival, LEAST, cost, their_cost, accuracy, fair=fair)]
    for name, load in loads.items():
        (_, cost), (_, their_cost) = measure_both(_often(ours, load), _often(theirs, load), runs=9)
        found.append(race(works[name], rival, LEAST, cost, their_cost, accuracy, fair=fair, note="ten times over"))
    return found


def _often(solve: Solve, load: Floats) -> Callable[[], None]:
    def work() -> None:
        for _ in range(10):
            solve(load)

    return work


def _accuracy(matrix: csr_array, ours: Solve, theirs: Solve, load: Floats) -> tuple[str, bool]:
    errors = [float(np.abs(matrix @ solve(load) - load).max()) for solve in (ours, theirs)]
    return f"|A x - b| {errors[0]:.0e} and {errors[1]:.0e}", errors[0] <= 10.0 * errors[1]


def _matrix(mesh: Any) -> csr_array:
    operator = fem(mesh)
    return csr_array(stiffness(operator) + mass_matrix(operator))


def _columns(solve: Callable[[Floats], Floats]) -> Solve:
    return lambda load: _each(solve, load)


def _each(solve: Callable[[Floats], Floats], load: Floats) -> Floats:
    if load.ndim == 1:
        return solve(load)
    return np.stack([solve(np.ascontiguousarray(column)) for column in load.T], axis=1)


def _cholespy(matrix: csr_array) -> Callable[[], Solve]:
    import cholespy

    given = csc_array(matrix)
    rows, columns = given.indptr.astype(np.int32), given.indices.astype(np.int32)

    def factorise() -> Solve:
        solver = cholespy.CholeskySolverD(given.shape[0], rows, columns, given.data, cholespy.MatrixType.CSC)

        def solve(load: Floats) -> Floats:
            solution = np.zeros_like(load)
            solver.solve(load, solution)
            return solution

        return solve

    return factorise


def _splu(matrix: csr_array) -> Callable[[], Solve]:
    given = csc_array(matrix)
    settings = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    return lambda: splu(given, **settings).solve


def _qdldl(matrix: csr_array) -> Callable[[], Solve]:
    import qdldl
    from scipy.sparse import csc_matrix

    upper = csc_matrix(triu(matrix))
    return lambda: _columns(qdldl.Solver(upper, upper=True).solve)


def _cholmod(matrix: csr_array) -> Callable[[], Solve]:
    from scipy.sparse import csc_matrix
    from sksparse.cholmod import cholesky

    given = csc_matrix(matrix)
    return lambda: cholesky(given)


RIVALS: dict[str, tuple[str, Callable[[csr_array], Callable[[], Solve]]]] = {
    "cholespy": ("cholespy", _cholespy),
    "CHOLMOD": ("sksparse", _cholmod),
    "SuperLU": ("scipy", _splu),
    "QDLDL": ("qdldl", _qdldl),
}
