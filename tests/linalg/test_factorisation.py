"""One factorisation interface: right solutions, an honest fallback, refusals; and Gauss-Seidel sweeps."""

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array

from surfexp.linalg import factorisation as module
from surfexp.linalg.factorisation import factorise
from surfexp.linalg.gauss_seidel import gauss_seidel
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import stiffness
from surfexp.operators.fem import fem


@pytest.fixture(scope="module")
def matrix() -> csr_array:
    operator = fem(icosphere(3).mesh)
    return csr_array(diags_array(operator.mass) + 0.1 * stiffness(operator))


@pytest.mark.parametrize("columns", [None, 1, 3])
def test_solutions_satisfy_the_system(matrix: csr_array, columns: int | None) -> None:
    shape = (matrix.shape[0],) if columns is None else (matrix.shape[0], columns)
    right = np.random.default_rng(0).normal(size=shape)
    solution = factorise(matrix).solve(right)
    assert solution.shape == shape
    assert np.abs(matrix @ solution - right).max() <= 1e-11 * np.abs(right).max()


def test_superlu_is_the_fallback_and_agrees(matrix: csr_array, monkeypatch: pytest.MonkeyPatch) -> None:
    right = np.random.default_rng(1).normal(size=matrix.shape[0])
    expected = factorise(matrix)
    assert expected.backend == "cholespy"

    def wrong(_: object) -> object:
        return lambda b: b

    monkeypatch.setattr(module, "_cholespy", wrong)
    other = factorise(matrix)
    assert other.backend == "superlu"
    assert np.allclose(other.solve(right), expected.solve(right), rtol=0, atol=1e-9)


def test_singular_and_malformed_matrices_are_refused(matrix: csr_array) -> None:
    with pytest.raises(ValueError, match="no factorisation solves"):
        factorise(csr_array(np.zeros((4, 4))))
    with pytest.raises(ValueError, match="3 x 2"):
        factorise(csr_array(np.ones((3, 2))))
    with pytest.raises(ValueError, match="not finite"):
        factorise(csr_array(np.diag([1.0, np.nan])))
    with pytest.raises(ValueError, match="has 3 rows"):
        factorise(matrix).solve(np.zeros(3))


def test_gauss_seidel_lowers_the_energy_and_converges(matrix: csr_array) -> None:
    right = np.random.default_rng(2).normal(size=matrix.shape[0])

    def energy(x: np.ndarray) -> float:
        return float(0.5 * x @ (matrix @ x) - right @ x)

    zero = np.zeros_like(right)
    once, twice = gauss_seidel(matrix, right, zero, 1), gauss_seidel(matrix, right, zero, 2)
    assert energy(zero) > energy(once) > energy(twice) > energy(factorise(matrix).solve(right))
    assert np.allclose(gauss_seidel(matrix, right, once, 1), twice)
    many = gauss_seidel(matrix, right, zero, 4000)
    assert np.abs(many - factorise(matrix).solve(right)).max() <= 1e-8 * np.abs(many).max()
