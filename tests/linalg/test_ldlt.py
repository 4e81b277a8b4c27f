"""The sparse LDL^T against dense algebra: solves, inertia, refactoring, orderings."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigvalsh
from scipy.sparse import block_diag, coo_array, csr_array, diags_array, eye_array, random_array
from scipy.sparse.linalg import LinearOperator, eigsh

from surfexp.linalg.ldlt import LDLT, ldlt
from surfexp.linalg.ldlt_ordering import nested_dissection
from surfexp.linalg.ldlt_symbolic import analyse, permuted
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem


def grid_laplacian(rows: int, columns: int) -> csr_array:
    index = np.arange(rows * columns).reshape(rows, columns)
    pairs = np.concatenate(
        [
            np.stack([index[1:].ravel(), index[:-1].ravel()], 1),
            np.stack([index[:, 1:].ravel(), index[:, :-1].ravel()], 1),
        ]
    )
    joined = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(index.size,) * 2).tocsr()
    joined = joined + joined.T
    return csr_array(diags_array(joined.sum(axis=1)) - joined)


def clustered_matrix(size: int, seed: int) -> csr_array:
    """Symmetric matrix of `size` rows: many copies of few small blocks, coupled by 1e-7, so eigenvalues come in clusters."""
    rng = np.random.default_rng(seed)
    copies = [grid_laplacian(5, 5)] * (size // 50) + [grid_laplacian(1, 25)] * (size // 50)
    coupling = random_array((size, size), density=3 / size, rng=rng, format="csr")
    return csr_array(block_diag(copies) + 1e-7 * (coupling + coupling.T))


def surface_pencil(mesh) -> tuple[csr_array, csr_array]:
    operator = fem(mesh)
    return stiffness(operator), mass_matrix(operator)


def test_inertia_equals_dense_counts_at_random_shifts_on_a_clustered_spectrum() -> None:
    matrix = clustered_matrix(500, 0)
    values = eigvalsh(matrix.toarray())
    symbolic = analyse(matrix + eye_array(500))
    rng = np.random.default_rng(1)
    inside_clusters = np.concatenate([values[::25] + 3e-8, values[::25] - 3e-8])
    for shift in np.concatenate([rng.uniform(-0.1, 8.1, 100), inside_clusters]):
        factors = LDLT(permuted(csr_array(matrix - shift * eye_array(500)), symbolic.permutation), symbolic)
        doubt = 10.0 * factors.perturbation
        count = factors.inertia[0]
        assert (values < shift - doubt).sum() <= count <= (values < shift + doubt).sum(), f"at {shift}"
        if shift not in inside_clusters:
            assert doubt < 1e-9 and count == (values < shift).sum(), f"at {shift}"


@pytest.mark.parametrize("mesh", [icosphere(4).mesh, disk(20).mesh], ids=["closed", "boundary"])
@pytest.mark.parametrize("shift", [-1.0, 23.7, 211.3])
def test_solves_to_rounding_at_interior_shifts(mesh, shift: float) -> None:
    a, b = surface_pencil(mesh)
    matrix = csr_array(a - shift * b)
    factors = ldlt(matrix)
    truth = np.random.default_rng(0).normal(size=(matrix.shape[0], 11))
    solution = factors.solve(matrix @ truth)
    assert np.linalg.norm(matrix @ (solution - truth)) <= 1e-12 * np.linalg.norm(matrix @ truth)
    assert factors.residual < 1e-11 and factors.replaced_pivots == 0
    assert np.array_equal(factors.solve((matrix @ truth)[:, 3]), factors.solve((matrix @ truth)[:, 3:4])[:, 0])


def test_refactoring_equals_a_fresh_factor() -> None:
    a, b = surface_pencil(disk(12).mesh)
    factors = ldlt(a - 3.0 * b)
    fresh = ldlt(a - 50.0 * b)
    order = factors.symbolic.permutation
    factors.refactor_in_order(permuted(csr_array(a - 50.0 * b), order))
    load = np.random.default_rng(2).normal(size=a.shape[0])
    assert np.array_equal(factors.solve(load), fresh.solve(load))
    assert factors.inertia == fresh.inertia


def test_several_components_and_isolated_vertices() -> None:
    pieces = [grid_laplacian(9, 9), csr_array([[2.0]]), grid_laplacian(30, 3), csr_array([[-1.0]])]
    matrix = csr_array(block_diag(pieces)) - 0.37 * eye_array(173)
    factors = ldlt(matrix)
    values = eigvalsh(matrix.toarray())
    assert factors.inertia == ((values < 0).sum(), (values > 0).sum())
    load = np.arange(173.0)
    assert np.allclose(factors.solve(load), np.linalg.solve(matrix.toarray(), load), rtol=1e-11, atol=1e-11)


def test_a_singular_matrix_is_refused() -> None:
    with pytest.raises(ValueError, match=r"matrix is singular to rounding.*: shift it"):
        ldlt(grid_laplacian(20, 20))
    with pytest.raises(ValueError, match=r"1 of its 3 pivots are below 1\.0e-14, the first of row 1: shift it"):
        ldlt(csr_array(np.diag([1.0, 0.0, 2.0])))
    assert ldlt(grid_laplacian(20, 20) + 1e-3 * eye_array(400)).residual < 1e-12


@given(st.integers(5, 60), st.floats(0.02, 0.3), st.integers(0, 1000))
@settings(max_examples=60, deadline=None)
def test_rounding_that_stands_on_one_side_of_the_diagonal_changes_nothing(size: int, density: float, seed: int) -> None:
    """Sums of sparse matrices drop entries that cancel: their pattern may be symmetric to rounding alone."""
    rng = np.random.default_rng(seed)
    half = random_array((size, size), density=density, rng=rng)
    matrix = csr_array(half + half.T + diags_array(np.full(size, 4.0)))
    places = rng.integers(0, size, (2, 3 * size))
    one_sided = csr_array(matrix + coo_array((np.full(3 * size, 1e-17), tuple(places)), shape=matrix.shape).tocsr())
    load = rng.normal(size=size)
    factor = ldlt(one_sided)
    np.testing.assert_allclose(matrix @ factor.solve(load), load, atol=1e-11)
    factor.refactor(one_sided.T)
    np.testing.assert_allclose(matrix @ factor.solve(load), load, atol=1e-11)


def test_large_fronts_use_the_blocked_path() -> None:
    rng = np.random.default_rng(3)
    dense = rng.normal(size=(230, 230))
    dense = dense + dense.T + 40.0 * np.diag(np.sign(rng.normal(size=230)))
    factors = ldlt(csr_array(dense))
    values = eigvalsh(dense)
    assert factors.inertia[0] == (values < 0).sum()
    load = rng.normal(size=(230, 8))
    assert np.linalg.norm(dense @ factors.solve(load) - load) < 1e-10 * np.linalg.norm(load)


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 60), st.floats(0.01, 0.5), st.integers(0, 10_000))
def test_any_symmetric_pattern_solves_and_counts(size: int, density: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    half = random_array((size, size), density=density, rng=rng, format="csr")
    signs = diags_array(np.sign(rng.normal(size=size)) * (size + 1.0))
    matrix = csr_array(half + half.T + signs)
    factors = ldlt(matrix)
    assert factors.inertia[0] == (eigvalsh(matrix.toarray()) < 0).sum()
    load = rng.normal(size=(size, 3))
    assert np.allclose(matrix @ factors.solve(load), load, atol=1e-11)


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 400), st.floats(0.0, 0.03), st.integers(0, 10_000))
def test_nested_dissection_is_a_permutation(size: int, density: float, seed: int) -> None:
    half = random_array((size, size), density=density, rng=np.random.default_rng(seed), format="csr")
    graph = csr_array(half + half.T + eye_array(size))
    order = nested_dissection(graph.indptr, graph.indices)
    assert np.array_equal(np.sort(order), np.arange(size))
    assert np.array_equal(order, nested_dissection(graph.indptr, graph.indices))


def test_fill_grows_like_n_log_n_on_a_surface() -> None:
    entries = [analyse(surface_pencil(icosphere(k).mesh)[0]).entries / (10 * 4**k + 2) for k in (3, 4, 5, 6)]
    assert np.all(np.diff(entries) < 11.0)
    assert entries[-1] < 62.0


def test_another_matrix_in_the_given_order_takes_the_place_of_the_first() -> None:
    a, b = surface_pencil(disk(12).mesh)
    factors, fresh = ldlt(a + b), ldlt(a - 50.0 * b)
    load = np.random.default_rng(2).normal(size=a.shape[0])
    before = factors.solve(load)
    factors.refactor(a - 50.0 * b)
    assert np.array_equal(factors.solve(load), fresh.solve(load)) and factors.inertia == fresh.inertia
    factors.refactor(a + b)
    assert np.array_equal(factors.solve(load), before)
    factors.refactor(diags_array(b.diagonal()))
    assert np.allclose(factors.solve(load), load / b.diagonal(), rtol=1e-13, atol=0.0)


def test_another_pattern_is_refused() -> None:
    factors = ldlt(eye_array(4).tocsr())
    with pytest.raises(ValueError, match=r"2 entries where the factorised one has none: factorise it anew"):
        factors.refactor(csr_array(np.eye(4) + 0.1 * np.eye(4)[[3, 1, 2, 0]] * [1, 0, 0, 1]))
    with pytest.raises(ValueError, match="3 rows, the analysis is of one with 4"):
        factors.refactor(eye_array(3).tocsr())


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 40), st.integers(1, 12), st.integers(0, 10_000))
def test_one_right_hand_side_is_solved_as_many_are(size: int, columns: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    half = random_array((size, size), density=0.3, rng=rng, format="csr")
    matrix = csr_array(half + half.T + diags_array(np.full(size, size + 1.0)))
    factors, load = ldlt(matrix), rng.normal(size=(size, columns))
    one_by_one = np.stack([factors.solve(load[:, column]) for column in range(columns)], axis=1)
    assert np.allclose(factors(load), one_by_one, rtol=1e-13, atol=1e-15)
    assert np.allclose(matrix @ one_by_one, load, rtol=0, atol=1e-13)


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 40), st.integers(0, 10_000))
def test_determinants_are_those_of_dense_algebra(size: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    half = random_array((size, size), density=0.2, rng=rng, format="csr")
    matrix = csr_array(half + half.T + diags_array(np.sign(rng.normal(size=size)) * (size + 1.0)))
    factors = ldlt(matrix)
    sign, logarithm = np.linalg.slogdet(matrix.toarray())
    assert factors.slogdet() == pytest.approx((sign, logarithm), rel=1e-12, abs=1e-12)
    assert np.isnan(factors.logdet()) if sign < 0 else factors.logdet() == factors.slogdet()[1]


def test_solves_of_a_badly_pivoted_matrix_are_refined() -> None:
    blocks = [np.array([[1e-7, 1.0], [1.0, 1e-7 + k]]) for k in range(5)]
    matrix, truth = csr_array(block_diag(blocks)), np.random.default_rng(0).normal(size=10)
    factors, load = ldlt(matrix), matrix @ truth
    assert factors.backward_error > 1e-12
    assert np.allclose(factors.solve(load), truth, rtol=0, atol=1e-14)
    assert factors.inertia[0] == (eigvalsh(matrix.toarray()) < 0).sum()


def test_a_factor_stands_where_scipy_wants_an_inverse() -> None:
    a, b = surface_pencil(icosphere(3).mesh)
    factors = ldlt(csr_array(a + 0.01 * b))
    inverse = LinearOperator(a.shape, matvec=factors, dtype=float)
    values = eigsh(a, 6, b, sigma=-0.01, OPinv=inverse, return_eigenvectors=False)
    assert np.allclose(np.sort(values)[1:4], 2.0, rtol=2e-2)
    assert factors.shape == a.shape and factors.memory > 8 * factors.symbolic.entries


def test_bad_matrices_are_refused() -> None:
    with pytest.raises(ValueError, match="shape 2 x 3"):
        ldlt(csr_array(np.ones((2, 3))))
    with pytest.raises(ValueError, match="1 entries that are not finite"):
        ldlt(csr_array(np.array([[1.0, 0.0], [0.0, np.nan]])))
    with pytest.raises(ValueError, match="5 rows"):
        ldlt(eye_array(3).tocsr()).solve(np.ones(5))
    with pytest.raises(ValueError, match="4 rows"):
        ldlt(eye_array(4).tocsr(), analyse(eye_array(3).tocsr()))
    with pytest.raises(
        ValueError, match=r"not symmetric, .* is up to 1\.0e\+00, at most 1\.0e-12 .*: give both triangles"
    ):
        ldlt(csr_array(np.array([[1.0, 1.0], [0.0, 1.0]])))
    with pytest.raises(ValueError, match="matrix is complex"):
        ldlt(csr_array(np.eye(2) * 1j))
    with pytest.raises(ValueError, match="right-hand side is complex"):
        ldlt(np.eye(2)).solve(np.ones(2) * 1j)
    with pytest.raises(ValueError, match="0 rows"):
        ldlt(np.eye(2)).solve(3.0)
    with pytest.raises(ValueError, match=r"right-hand side is sparse.*: give b\.toarray\(\)"):
        ldlt(np.eye(2)).solve(eye_array(2))
    with pytest.raises(ValueError, match=r"symbolic is a float.*: give factor\.symbolic, or matrix \+ beta I"):
        ldlt(np.eye(2), 0.5)


def test_a_factor_stands_where_that_of_cholmod_did() -> None:
    """What callers of `sksparse.cholmod.cholesky` use: a call for a solve, logdet, slogdet."""
    matrix = grid_laplacian(6, 7) + csr_array(eye_array(42))
    factor = ldlt(matrix.tocsc())
    sign, logarithm = np.linalg.slogdet(matrix.toarray())
    np.testing.assert_allclose(matrix @ factor(np.arange(42.0)), np.arange(42.0), atol=1e-12)
    np.testing.assert_allclose([factor.logdet(), *factor.slogdet()], [logarithm, sign, logarithm], rtol=1e-12)


@pytest.mark.parametrize("kind", [np.int64, bool, np.float32, np.float64])
def test_the_matrix_that_was_given_keeps_its_entries(kind: type) -> None:
    """Rows whose columns are not sorted: sorting them in place would move the entries of the caller's array."""
    shared = csr_array((np.array([1, 4, 5, 1], dtype=kind), [1, 0, 1, 0], [0, 2, 4]), shape=(2, 2))
    dense, indices = shared.toarray(), shared.indices.copy()
    if kind is bool:
        with pytest.raises(ValueError, match="singular"):
            ldlt(shared)
    else:
        ldlt(shared).refactor(shared)
    np.testing.assert_array_equal(shared.toarray(), dense)
    np.testing.assert_array_equal(shared.indices, indices)


def test_a_sparser_matrix_leaves_the_analysis_as_it_was() -> None:
    path = grid_laplacian(1, 100) + csr_array(eye_array(100))
    factors, load = ldlt(path), np.arange(100.0)
    before = factors.solve(load)
    factors.refactor(2.0 * eye_array(100))
    factors.refactor(path)
    assert np.array_equal(factors.solve(load), before)


@given(st.integers(2, 40), st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_an_analysis_serves_the_matrices_it_has_places_for_and_no_others(size: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    half = random_array((size, size), density=2.0 / size, rng=rng, format="csr")
    first = csr_array(half + half.T + diags_array(np.full(size, size + 1.0)))
    entry = coo_array(([0.5], rng.integers(0, size, (2, 1))), shape=first.shape)
    other, load = csr_array(first + entry + entry.T), rng.normal(size=size)
    symbolic = ldlt(first).symbolic
    try:
        factors = ldlt(other, symbolic=symbolic)
    except ValueError as error:
        assert "where the factorised one has none" in str(error)
        assert other.nnz > first.nnz
    else:
        assert np.allclose(other @ factors.solve(load), load, rtol=0, atol=1e-12)


def test_stored_zeros_need_no_place() -> None:
    first = csr_array(diags_array([3.0, 4.0, 5.0]))
    full = csr_array((np.diag([3.0, 4.0, 5.0]).ravel(), np.tile(range(3), 3), [0, 3, 6, 9]), shape=(3, 3))
    assert full.nnz == 9
    np.testing.assert_array_equal(ldlt(full, ldlt(first).symbolic).solve([3.0, 4.0, 5.0]), np.ones(3))


@pytest.mark.parametrize("power", [-900, -500, 500, 538, 900])
def test_a_power_of_two_scales_factors_and_solves_to_the_bit(power: int) -> None:
    """Norms of solutions near 1e-162 have squares that are 0."""
    matrix, load = grid_laplacian(8, 9) + csr_array(eye_array(72)), np.sin(np.arange(72.0))
    scaled, plain = ldlt(matrix * 2.0**power), ldlt(matrix)
    np.testing.assert_array_equal(scaled.solve(load) * 2.0**power, plain.solve(load))
    assert scaled.residual == plain.residual and scaled.perturbation == plain.perturbation * 2.0**power
    assert scaled.inertia == plain.inertia
