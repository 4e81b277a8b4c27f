"""Chebyshev sums of a matrix are those of its eigenvalues, for several series of any length at once."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array

from surfexp.linalg.chebyshev_sums import chebyshev_sums


@given(st.integers(0, 1000), st.lists(st.integers(1, 30), min_size=1, max_size=4))
def test_they_are_those_of_the_eigenvalues(seed: int, lengths: list[int]) -> None:
    random = np.random.default_rng(seed)
    basis = np.linalg.qr(random.standard_normal((6, 6)))[0]
    eigenvalues = random.uniform(0.0, 3.0, 6)
    series = [random.standard_normal(length) for length in lengths]
    values = random.standard_normal((6, 2))
    before = values.copy()
    matrix = csr_array(basis @ np.diag(eigenvalues) @ basis.T)
    for found, coefficients in zip(chebyshev_sums(matrix, 3.0, values, series), series, strict=True):
        expected = np.polynomial.chebyshev.chebval(2.0 * eigenvalues / 3.0 - 1.0, coefficients)
        assert np.allclose(found, basis @ (expected[:, None] * (basis.T @ values)), atol=1e-11)
    assert (values == before).all()
