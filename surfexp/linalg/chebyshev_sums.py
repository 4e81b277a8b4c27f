"""Sums of Chebyshev polynomials of a matrix times vectors, by their recurrence."""

from __future__ import annotations

from collections.abc import Sequence

from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats


def chebyshev_sums(matrix: csr_array, largest: float, values: Floats, series: Sequence[Floats]) -> list[Floats]:
    """Return the sums of c_k T_k(2 A / largest - 1) f, for several series c by one recurrence.

    Parameters
    ----------
    matrix : (n, n) csr_array of float64
        A, with real eigenvalues in [0, largest].
    largest : float
    values : (n,) or (n, c) float64
        f.
    series : sequence of (k,) float64
        Coefficients c, at least one of each.

    Returns
    -------
    list of (like `values`)

    References
    ----------
    Clenshaw: A note on the summation of Chebyshev series (1955), for the stability of the recurrence.

    Examples
    --------
    >>> import numpy as np
    >>> from scipy.sparse import csr_array
    >>> matrix = csr_array(np.diag([0.0, 1.0, 2.0]))
    >>> chebyshev_sums(matrix, 2.0, np.ones(3), [np.array([0.0, 0.0, 1.0])])[0].tolist()
    [1.0, -1.0, 1.0]
    """
    scale = 2.0 / largest

    def shifted(field: Floats) -> Floats:
        return scale * (matrix @ field) - field

    before, now = values, shifted(values)
    totals = [given[0] * before + (given[1] * now if len(given) > 1 else 0.0) for given in series]
    for term in range(2, max(map(len, series))):
        before, now = now, 2.0 * shifted(now) - before
        for total, given in zip(totals, series, strict=True):
            if term < len(given):
                total += given[term] * now
    return totals
