"""Gauss-Seidel sweeps against a factorisation."""

import numpy as np
from scipy.sparse import csr_array, diags_array

from surfexp.linalg.gauss_seidel import gauss_seidel
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import stiffness
from surfexp.operators.fem import fem


def test_gauss_seidel_lowers_the_energy_and_converges() -> None:
    operator = fem(icosphere(3).mesh)
    matrix = csr_array(diags_array(operator.mass) + 0.1 * stiffness(operator))
    right = np.random.default_rng(2).normal(size=matrix.shape[0])

    def energy(x: np.ndarray) -> float:
        return float(0.5 * x @ (matrix @ x) - right @ x)

    zero = np.zeros_like(right)
    once, twice = gauss_seidel(matrix, right, zero, 1), gauss_seidel(matrix, right, zero, 2)
    assert energy(zero) > energy(once) > energy(twice) > energy(ldlt(matrix).solve(right))
    assert np.allclose(gauss_seidel(matrix, right, once, 1), twice)
    many = gauss_seidel(matrix, right, zero, 4000)
    assert np.abs(many - ldlt(matrix).solve(right)).max() <= 1e-8 * np.abs(many).max()
