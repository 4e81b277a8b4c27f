"""The shifted pencil: counts, shifts that hit an eigenvalue, and the counting function."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse import csr_array, diags_array

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import flat_torus
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.elements_nodes import number_nodes
from surfexp.operators.elements_surface import assemble_elements
from surfexp.operators.fem import fem
from surfexp.spectrum.counting_function import guess_eigenvalue
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.single_slice import solve_accuracy


@pytest.fixture(scope="module")
def matrices() -> tuple[csr_array, csr_array, np.ndarray]:
    operator = fem(icosphere(3).mesh)
    a, b = stiffness(operator), mass_matrix(operator)
    return a, b, eigh(a.toarray(), b.toarray(), eigvals_only=True)


@pytest.mark.parametrize("lumped", [False, True])
def test_counts_and_solutions(matrices, lumped: bool) -> None:
    a, b, values = matrices
    if lumped:
        b = csr_array(diags_array(b.sum(axis=1)))
        values = eigh(a.toarray(), b.toarray(), eigvals_only=True)
    pencil = ShiftedPencil(a, b)
    for wanted in (-1.0, 7.3, 55.0, 111.1):
        shift, factors = pencil.factor(wanted)
        assert shift == wanted and pencil.counts[shift] == (values < shift).sum()
        x = np.random.default_rng(0).normal(size=(642, 8))
        load = pencil.stiffness @ x - shift * pencil.multiply_mass(x)
        factors.solve_in_order(load)
        assert np.allclose(load, x, atol=1e-8)
    assert np.allclose(pencil.mass.todense(), b.todense()[np.ix_(pencil.order, pencil.order)])


def test_a_shift_on_an_eigenvalue_moves_a_little(matrices) -> None:
    a, b, values = matrices
    pencil = ShiftedPencil(a, b)
    for exact in (0.0, float(values[2]), float(values[30])):
        shift, factors = pencil.factor(exact)
        assert factors.residual <= 1e-9
        assert abs(shift - exact) <= 1e-2 * max(exact, 1.0)
        distance = np.abs(values - shift).min()
        if distance > pencil.doubts[shift]:
            assert pencil.counts[shift] == (values < shift).sum()


def test_the_best_of_several_shifts_is_taken_where_none_is_good_enough(matrices) -> None:
    a, b, values = matrices
    pencil = ShiftedPencil(a, b)
    shift, _ = pencil.factor(50.0, accuracy=0.0)
    assert len(pencil.counts) > 3 and pencil.doubts[shift] == min(pencil.doubts.values())
    assert all(count == (values < at).sum() for at, count in pencil.counts.items())
    quick = ShiftedPencil(a, b)
    assert quick.factor(50.0)[0] == 50.0 and len(quick.counts) == 1


def test_factors_are_those_of_the_shift_that_is_returned(matrices) -> None:
    a, b, _ = matrices
    pencil, before_the_last = ShiftedPencil(a, b), 0
    for wanted in np.linspace(10.0, 110.0, 12):
        pencil.counts.clear()
        shift, factors = pencil.factor(float(wanted), accuracy=0.0)
        before_the_last += shift != list(pencil.counts)[-1]
        x = np.random.default_rng(0).normal(size=(642, 8))
        load = pencil.stiffness @ x - shift * pencil.multiply_mass(x)
        factors.solve_in_order(load)
        assert np.allclose(load, x, atol=1e-8)
    assert before_the_last > 3


def test_a_hopeless_pencil_is_refused() -> None:
    # every third pivot vanishes at any shift, and elimination does not pivot
    zero = csr_array(np.kron(np.eye(10), [[0.0, 1.0], [1.0, 0.0]]))
    tiny = csr_array(diags_array(np.full(20, 1e-13)))
    with pytest.raises(ValueError, match="repair slivers"):
        ShiftedPencil(zero, tiny).factor(1e-6)


def test_counting_function_starts_from_weyl_and_follows_counts() -> None:
    assert guess_eigenvalue(100.0, 4.0 * np.pi, {}) == pytest.approx(100.0)
    assert guess_eigenvalue(50.0, 4.0 * np.pi, {100.0: 50}) == pytest.approx(100.0)
    tube = {100.0: 10, 400.0: 20}  # N grows like the root of the shift
    assert guess_eigenvalue(40.0, 4.0 * np.pi, tube) == pytest.approx(1600.0)
    assert guess_eigenvalue(14.0, 4.0 * np.pi, tube) == pytest.approx(196.0, rel=0.02)
    assert guess_eigenvalue(10.0, 4.0 * np.pi, {10.0: 0}) > 10.0


def test_good_enough_grows_with_the_rows() -> None:
    assert solve_accuracy(100_000) == solve_accuracy(1_000) == 2e-10
    assert solve_accuracy(1_000_000) == pytest.approx(2e-9)


@pytest.mark.slow
def test_a_large_pencil_is_factorised_no_oftener_than_a_small_one() -> None:
    faces, corners = flat_torus(800)
    elements = assemble_elements(number_nodes(faces, 640_000, 1), corners)
    system = eigenpairs(elements.stiffness, elements.mass, 10)
    assert system.metrics["factorisations"] <= 3 and system.complete
