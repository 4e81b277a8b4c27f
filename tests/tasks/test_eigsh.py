"""The call of scipy's eigsh, answered with a proof."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.linalg import eigsh as arpack

import surfexp as sx
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem

OPERATOR = fem(sx.shape("ellipsoid", levels=4).mesh)
A, M = stiffness(OPERATOR), mass_matrix(OPERATOR)


@pytest.mark.parametrize("call", [{"sigma": -0.01}, {"sigma": -0.01, "which": "LM"}, {"sigma": 0.0}, {"which": "SM"}])
def test_values_and_spaces_are_those_of_scipy(call: dict) -> None:
    values, vectors = sx.eigsh(A, 10, M, **call)
    expected, others = arpack(A, 10, M, sigma=-0.01)
    order = np.argsort(expected)
    assert values == pytest.approx(expected[order], rel=1e-9, abs=1e-9)
    assert vectors.shape == others.shape
    assert np.abs(np.abs(np.diag(vectors.T @ (M @ others[:, order]))) - 1.0).max() < 1e-6
    assert np.array_equal(sx.eigsh(A, 10, M, return_eigenvectors=False, **call), values)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        ({"sigma": 1.0}, "sigma = 1.0"),
        ({"which": "LM"}, "which = 'LM'"),
        ({"sigma": -1, "mode": "buckling"}, "buckling"),
    ],
)
def test_other_parts_of_the_spectrum_are_refused_by_name(call: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        sx.eigsh(A, 4, M, **call)


def test_dense_matrices_are_refused() -> None:
    with pytest.raises(ValueError, match="sparse"):
        sx.eigsh(np.eye(5), 2, sigma=0)
    assert sx.eigsh(csr_array(np.diag(np.arange(8.0))), 2, sigma=0)[0] == pytest.approx([0.0, 1.0], abs=1e-12)
