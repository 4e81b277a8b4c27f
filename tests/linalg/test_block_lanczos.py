"""Block Lanczos: the projected operator, orthogonality, purification, dependent blocks."""

from __future__ import annotations

import numpy as np
import pytest
from numba.core.errors import TypingError
from scipy.linalg import eigh
from scipy.sparse import csr_array, diags_array

from surfexp.linalg.block_lanczos import BLOCK, BlockLanczos
from surfexp.linalg.block_products import (
    gram,
    multiply_lanes,
    multiply_right,
    residual_norms,
    subtract_product,
    subtract_two,
)
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem

SHIFT = 31.3


@pytest.fixture(scope="module")
def pencil() -> tuple[csr_array, csr_array, np.ndarray, np.ndarray]:
    ball = icosphere(3).mesh
    operator = fem(TriangleMesh(ball.vertices * [1.3, 1.0, 0.7], ball.faces))
    a, b = stiffness(operator), mass_matrix(operator)
    values, vectors = eigh(a.toarray(), b.toarray())
    return a, b, values, vectors


def lanczos_of(a: csr_array, b: csr_array, steps: int, locked: np.ndarray | None = None) -> BlockLanczos:
    factors = ldlt(a - SHIFT * b)

    def solve(block: np.ndarray) -> None:
        block[:] = factors.solve(block)

    result = BlockLanczos(solve, lambda block, result: b @ block, a.shape[0], (steps + 4) * BLOCK, locked)
    for _ in range(steps):
        result.extend()
    return result


def test_converged_pairs_are_the_nearest_to_the_shift(pencil) -> None:
    a, b, values, vectors = pencil
    lanczos = lanczos_of(a, b, 16)
    ritz = lanczos.ritz()
    good = np.flatnonzero(ritz.residuals / ritz.values**2 < 1e-9)
    found = np.sort(SHIFT + 1.0 / ritz.values[good])
    assert len(found) >= 12
    assert np.abs(found[:, None] - values).min(axis=1).max() < 1e-9
    inside = (values >= found[0] - 1e-9) & (values <= found[-1] + 1e-9)
    assert np.allclose(found, values[inside], rtol=1e-10)  # no gaps, no copies
    x = lanczos.vectors(ritz, good)
    assert np.abs(x.T @ (b @ x) - np.eye(len(good))).max() < 1e-10
    assert np.abs(np.abs(x.T @ (b @ vectors)).max(axis=1) - 1.0).max() < 1e-9


def test_residuals_are_those_of_the_operator(pencil) -> None:
    a, b, _, _ = pencil
    lanczos = lanczos_of(a, b, 9)
    ritz = lanczos.ritz()
    # without purification the residual of the inverted operator is exactly the coupling norm
    basis = lanczos._basis[:, : lanczos.dimension]
    x = basis @ ritz.coefficients
    error = ldlt(a - SHIFT * b).solve(b @ x) - x * ritz.values
    norms = np.sqrt(np.einsum("ij,ij->j", error, b @ error))
    assert np.allclose(norms, ritz.residuals, atol=1e-9 * np.abs(ritz.values).max())


def test_purification_gains_digits(pencil) -> None:
    a, b, _, _ = pencil
    lanczos = lanczos_of(a, b, 14)
    ritz = lanczos.ritz()
    chosen = np.flatnonzero((ritz.residuals / np.abs(ritz.values) < 1e-5) & (np.abs(ritz.values) < 0.2))
    values = SHIFT + 1.0 / ritz.values[chosen]

    def residual(x: np.ndarray) -> np.ndarray:
        return np.linalg.norm(a @ x - (b @ x) * values, axis=0) / np.linalg.norm(b @ x, axis=0)

    plain = residual(lanczos._basis[:, : lanczos.dimension] @ ritz.coefficients[:, chosen])
    purified = residual(lanczos.vectors(ritz, chosen))
    assert len(chosen) and (purified <= 1.01 * plain).all()
    assert purified.max() < 0.2 * plain.max()


def test_locked_vectors_are_not_found_again(pencil) -> None:
    a, b, values, vectors = pencil
    near = np.argsort(np.abs(values - SHIFT))[:5]
    lanczos = lanczos_of(a, b, 14, np.asfortranarray(vectors[:, near]))
    ritz = lanczos.ritz()
    good = np.flatnonzero(ritz.residuals / ritz.values**2 < 1e-8)
    found = SHIFT + 1.0 / ritz.values[good]
    gaps = np.abs(found[:, None] - values[near]).min()
    assert gaps > 1e-3
    assert np.abs(vectors[:, near].T @ (b @ lanczos.vectors(ritz, good))).max() < 1e-9


def test_dependent_blocks_are_replaced() -> None:
    # seven different values only: the Krylov space is exhausted after one block
    matrix = csr_array(diags_array(np.repeat(np.arange(1.0, 8.0), 30)))
    identity = csr_array(diags_array(np.ones(210)))

    def solve(block: np.ndarray) -> None:
        block /= matrix.diagonal()[:, None] - 3.5

    lanczos = BlockLanczos(solve, lambda block, result: identity @ block, 210, 160)
    for _ in range(15):
        lanczos.extend()
    basis = lanczos._basis[:, : lanczos.dimension]
    assert np.abs(basis.T @ basis - np.eye(120)).max() < 1e-8
    ritz = lanczos.ritz()
    found = 3.5 + 1.0 / ritz.values[ritz.residuals < 1e-9]
    assert np.abs(found - np.round(found)).max() < 1e-8
    assert (np.abs(found - 3.0) < 1e-8).sum() >= 8


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_block_with_dependent_columns_is_the_product_of_its_factors(scale: float) -> None:
    identity = csr_array(diags_array(np.ones(210)))
    lanczos = BlockLanczos(lambda block: None, lambda block, result: identity @ block, 210, 160)
    block = scale * np.random.default_rng(0).normal(size=(210, 8))
    block[:, 3] = block[:, 0] - 2.0 * block[:, 1]
    block[:, 5] = 0.0
    result, _, factor = lanczos._replace_dependent(block.copy(), scale)
    assert np.abs(result.T @ result - np.eye(8)).max() < 1e-12
    assert np.abs(result @ factor - block).max() < 1e-12 * scale
    assert np.flatnonzero(factor.diagonal() == 0.0).tolist() == [3, 5]


def test_block_products() -> None:
    rng = np.random.default_rng(0)
    a = mass_matrix(fem(icosphere(2).mesh))
    x, y, z, r, s = (rng.normal(size=shape) for shape in [(162, 8)] * 3 + [(8, 8)] * 2)
    assert np.allclose(multiply_lanes(a, x), a @ x, atol=1e-15)
    assert np.allclose(gram(x, y), x.T @ y, atol=1e-13)
    assert np.allclose(
        residual_norms(x, y, r[0]), [np.linalg.norm(x - y * r[0], axis=0), np.linalg.norm(y, axis=0)], rtol=1e-14
    )
    for work, arguments, expected in (
        (subtract_two, (y, r, z, s), x - y @ r - z @ s),
        (subtract_product, (y, r), x - y @ r),
        (multiply_right, (r,), x @ r),
    ):
        result = x.copy()
        work(result, *arguments)
        assert np.allclose(result, expected, atol=1e-13)


def test_blocks_of_another_order_are_refused() -> None:
    with pytest.raises(TypingError, match="C-ordered"):
        multiply_right(np.zeros((20, 8)), np.asfortranarray(np.eye(8)))
