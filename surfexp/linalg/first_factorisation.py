"""`python -m surfexp.linalg.first_factorisation`: let numba compile the factorisation, beside a first call that needs it later."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.linalg.ldlt import ldlt
from surfexp.linalg.ldlt_symbolic import SymbolicFactor

# from which number of right-hand sides on they are solved side by side
MANY = 8


def factorise_one_number() -> float:
    """Factorise and solve the smallest matrix; its analysis is given, since a first call compiles that meanwhile.

    Returns
    -------
    float
        The largest error of the solutions.
    """
    none, zero = np.empty(0, dtype=np.int64), np.zeros(1, dtype=np.int64)
    analysis = SymbolicFactor(zero, np.array([0, 1]), np.zeros(2, dtype=np.int64), none, zero - 1, np.array([0, 8]))
    factor = ldlt(csr_array(np.array([[2.0]])), analysis)
    return max(float(np.abs(factor.solve(np.ones((1, count))) - 0.5).max()) for count in (1, MANY))


if __name__ == "__main__":
    factorise_one_number()
