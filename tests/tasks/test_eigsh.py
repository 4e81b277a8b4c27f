"""The call of scipy's eigsh, answered with a proof."""

from __future__ import annotations

import numpy as np
import pytest
from random_pencils import drawn_pencil
from scipy.linalg import eigh
from scipy.sparse import csr_array
from scipy.sparse.linalg import aslinearoperator
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
    with pytest.raises(ValueError, match=r"scipy.sparse.csr_array\(A\)"):
        sx.eigsh(np.eye(5), 2, sigma=0)
    assert sx.eigsh(csr_array(np.diag(np.arange(8.0))), 2, sigma=0)[0] == pytest.approx([0.0, 1.0], abs=1e-12)


def magnetic_ring(count: int, flux: float) -> csr_array:
    """Laplacian of a ring with a phase on every edge; its values are 2 - 2 cos((2 pi j + flux) / n)."""
    near = np.arange(count)
    hops = csr_array((np.full(count, -np.exp(1j * flux / count)), (near, (near + 1) % count)), shape=(count, count))
    return csr_array(csr_array((np.full(count, 2.0), (near, near))) + hops + hops.conj().T)


@pytest.mark.parametrize(("count", "k"), [(5, 2), (60, 7), (900, 12), (900, 11)])
@pytest.mark.parametrize("flux", [0.3, np.pi, 0.0])
def test_complex_hermitian_matrices_are_solved(count: int, k: int, flux: float) -> None:
    """The exact values; pairs of equal ones at the fluxes 0 and pi, which an odd k or an even one cuts."""
    matrix = magnetic_ring(count, flux)
    exact = np.sort(4.0 * np.sin((2.0 * np.pi * np.arange(count) + flux) / (2 * count)) ** 2)[:k]
    values, vectors = sx.eigsh(matrix, k, sigma=0)
    assert values == pytest.approx(exact, rel=1e-7, abs=1e-11)
    assert vectors.shape == (count, k) and np.abs(vectors.conj().T @ vectors - np.eye(k)).max() < 1e-9
    assert np.abs(matrix @ vectors - vectors * values).max() < 1e-7 * exact[-1]


def test_a_complex_mass_is_not_cut_to_its_real_part() -> None:
    a, m = magnetic_ring(40, 1.0), magnetic_ring(40, -2.0) + 3.0 * magnetic_ring(40, 0.4)
    m = csr_array(m + csr_array(np.eye(40)))
    values, vectors = sx.eigsh(a, 6, m, sigma=0)
    assert values == pytest.approx(eigh(a.toarray(), m.toarray(), eigvals_only=True)[:6], rel=1e-8, abs=1e-11)
    assert np.abs(vectors.conj().T @ (m @ vectors) - np.eye(6)).max() < 1e-9


def test_matrices_that_are_not_hermitian_are_refused() -> None:
    matrix = magnetic_ring(30, 1.0)
    matrix.data[matrix.data.imag > 0] *= 1j
    with pytest.raises(ValueError, match="not symmetric"):
        sx.eigsh(matrix, 3, sigma=0)


@pytest.mark.parametrize("size", [1, 2])
@pytest.mark.parametrize("unit", [1.0, 1j])
def test_one_and_two_rows_are_a_pencil(size: int, unit: complex) -> None:
    a = np.array([[2.0, unit], [np.conj(unit), 3.0]])[:size, :size]
    values, vectors = sx.eigsh(csr_array(a), size, sigma=0)
    assert values == pytest.approx(np.linalg.eigvalsh(a), rel=1e-12)
    assert np.abs(a @ vectors - vectors * values).max() < 1e-9


@pytest.mark.parametrize("scales", [(1e200, 1.0), (1e-200, 1.0), (1.0, 1e200), (1.0, 1e-200), (1e200, 1e200)])
def test_the_unit_of_a_matrix_scales_the_values(scales: tuple[float, float]) -> None:
    values, vectors = sx.eigsh(A, 6, M, sigma=0)
    scaled, others = sx.eigsh(A * scales[0], 6, M * scales[1], sigma=0)
    assert scaled / (scales[0] / scales[1]) == pytest.approx(values, rel=1e-9, abs=1e-9)
    assert others * np.sqrt(scales[1]) == pytest.approx(vectors, rel=1e-6, abs=1e-6)


def test_operators_without_entries_are_refused_by_name() -> None:
    with pytest.raises(ValueError, match=r"M is a .*LinearOperator, a sparse matrix is needed"):
        sx.eigsh(A, 3, aslinearoperator(M), sigma=0)
    with pytest.raises(ValueError, match="A has entries that are not finite"):
        sx.eigsh(A * np.inf, 3, M, sigma=0)


def outcome(seed: int) -> str:
    """What becomes of a drawn pencil: "right", "refused" or how it is wrong."""
    drawn = drawn_pencil(seed)
    try:
        values, vectors = sx.eigsh(drawn.stiffness, drawn.k, drawn.mass, sigma=0)
    except ValueError as error:
        return "refused" if "\n" not in str(error) else f"refused in several lines: {error}"
    wanted, size = drawn.values[: drawn.k], np.abs(drawn.values).max()
    if not np.allclose(values, wanted, rtol=1e-7, atol=1e-11 * size):
        return f"{drawn.kind}: {values - wanted}"
    mass = np.eye(len(drawn.values)) if drawn.mass is None else drawn.mass
    gram = vectors.conj().T @ (mass @ vectors)
    return "right" if np.abs(gram - np.eye(drawn.k)).max() < 1e-6 else f"{drawn.kind}: not orthonormal"


@pytest.mark.parametrize(
    "seeds", [range(50), pytest.param(range(50, 500), marks=pytest.mark.slow)], ids=["fifty", "five hundred"]
)
def test_ordinary_pencils_are_solved_as_dense_algebra_does(seeds: range) -> None:
    """Graphs, grids, clusters, several components, n from 1, any scale, complex ones: at most 1 % refused, none wrong."""
    found = {seed: outcome(seed) for seed in seeds}
    wrong = {seed: what for seed, what in found.items() if what not in ("right", "refused")}
    assert not wrong
    assert sum(what == "refused" for what in found.values()) <= 0.01 * len(seeds)


def test_values_that_rounding_hides_are_found_as_well_as_any_method_finds_them() -> None:
    """The largest value is so far above the smallest ones that their residuals stay over 1e-8."""
    assert drawn_pencil(188).kind == "random" and outcome(188) == "right"


def test_a_pencil_that_is_unfit_gets_one_line_about_pencils() -> None:
    chain = csr_array(np.diag(np.arange(30.0)))
    weights = np.ones(30)
    weights[3] = 0.0
    with pytest.raises(
        ValueError, match=r"of degree of freedom 3 is 0.*: A must be positive semidefinite, M definite"
    ) as told:
        sx.eigsh(chain, 3, csr_array(np.diag(weights)), sigma=0)
    with pytest.raises(ValueError, match=r"below 0.*A must be positive semidefinite") as negative:
        sx.eigsh(csr_array(np.array([[1.0, 3.0], [3.0, 1.0]])), 1, sigma=0)
    for error in (told, negative):
        assert not any(word in str(error.value) for word in ("mesh", "sliver", "intrinsic", "\n"))
