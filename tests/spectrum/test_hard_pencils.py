"""Copies, slivers, clusters that k cuts, one pair, unfit matrices: k certified pairs, or one refusal that names the cause."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from drawn_pencils import Pencil, dense_values, pencil_of, pencils_and_counts, with_sliver
from hypothesis import HealthCheck, given, settings
from scipy.sparse import csr_array, diags_array

from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.spectrum import components, dense, eigensolver
from surfexp.spectrum.dense import dense_pairs
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.eigensystem import EigenSystem, measure
from surfexp.spectrum.pencil_checks import certified
from surfexp.spectrum.shifted_pencil import ShiftedPencil

BALL = icosphere(2).mesh

Matrices = tuple[csr_array, csr_array]


def scaled(mesh: TriangleMesh, factor: float) -> TriangleMesh:
    return TriangleMesh(factor * mesh.vertices, mesh.faces)


def copies(count: int, spread: float, mesh: TriangleMesh = BALL) -> Matrices:
    rng = np.random.default_rng(0)
    return pencil_of([scaled(mesh, factor) for factor in 1.0 + spread * rng.normal(size=count)])


def assert_certified(system: EigenSystem, a: csr_array, b: csr_array, k: int, tolerance: float = 1e-8) -> None:
    assert system.complete and system.values.shape == (k,) and system.vectors.shape == (a.shape[0], k)
    errors = np.linalg.norm(a @ system.vectors - (b @ system.vectors) * system.values, axis=0)
    relative = errors / np.linalg.norm(b @ system.vectors, axis=0) / np.maximum(system.values, system.spacing)
    # measured with sums in another order, a residual differs by rounding
    assert system.spacing > 0 and relative.max() <= 1.01 * tolerance + rounding_floor(system, a, b)
    assert np.abs(system.vectors.T @ (b @ system.vectors) - np.eye(k)).max() <= 1e-8


def assert_equal(system: EigenSystem, pencil: Pencil) -> None:
    """Values as by dense algebra, up to what the rounding of the matrix entries by one unit does to a value: eps v'|A|v.

    Beside a sliver of 1e-5 degrees entries of 1e7 cancel, and that is more than a ten millionth of the spacing.
    """
    exact, sizes = pencil.values[: len(system.values)], np.abs(system.vectors)
    rounding = np.finfo(float).eps * np.einsum("ij,ij->j", sizes, abs(pencil.stiffness) @ sizes)
    errors = np.abs(system.values - exact) / (np.maximum(exact, system.spacing) + 1e7 * rounding)
    worst = int(errors.argmax())
    assert errors[worst] <= 1e-7, (worst, len(exact), system.values[worst], exact[worst], system.spacing)


@pytest.mark.parametrize(("count", "spread"), [(12, 1e-6), (12, 1e-9), (21, 0.0)])
def test_equal_and_nearly_equal_spheres_at_every_cut(count: int, spread: float) -> None:
    a, b = copies(count, spread)
    one = dense_values(*pencil_of([BALL]))
    for k in (1, 10, count - 1, count, count + 1, 20, 4 * count - 1, 4 * count, 70):
        system = eigenpairs(a, b, k, "slicing")
        assert_certified(system, a, b, k)
        exact = np.repeat(one, count)[:k]
        assert np.abs(system.values - exact).max() < 10.0 * (spread + 1e-9) * exact[-1] + 1e-8


@pytest.mark.parametrize("method", ["auto", "slicing", "dense", "arpack"])
def test_one_pair_of_a_closed_surface(method: str) -> None:
    a, b = pencil_of([icosphere(3).mesh])
    system = eigenpairs(a, b, 1, method)
    assert_certified(system, a, b, 1)
    assert abs(system.values[0]) < 1e-9 and 0.1 < system.spacing < 2.1


def sliver_and_components(body: TriangleMesh, count: int, slivers: int) -> Matrices:
    """A mesh with slivers of .37 degrees beside many components of very different size."""
    for degrees in np.geomspace(0.37, 3.0, slivers):
        body = with_sliver(body, degrees)
    sizes = 10.0 ** np.random.default_rng(1).uniform(-2.5, -0.5, count)
    return pencil_of([body, *(scaled(icosphere(1).mesh, size) for size in sizes)])


def test_no_refusal_depends_on_k() -> None:
    a, b = sliver_and_components(icosphere(4).mesh, 43, 1)
    reference = eigenpairs(a, b, 100).values
    for k in (1, 43, 46, 60):
        system = eigenpairs(a, b, k)
        assert_certified(system, a, b, k)
        assert np.abs(system.values - reference[:k]).max() < 1e-7


@pytest.mark.slow
def test_no_refusal_depends_on_k_on_a_large_mesh() -> None:
    a, b = sliver_and_components(torus(180, 120).mesh, 43, 5)
    assert a.shape[0] > 20_000
    reference = eigenpairs(a, b, 100).values
    for k in range(40, 71):
        system = eigenpairs(a, b, k)
        assert_certified(system, a, b, k)
        assert np.abs(system.values - reference[:k]).max() < 1e-7


@pytest.mark.parametrize("degrees", [1e-1, 1e-3, 1e-5])
@pytest.mark.parametrize("method", ["auto", "slicing"])
def test_slivers_are_solved_or_refused_with_the_way_out(degrees: float, method: str) -> None:
    a, b = pencil_of([with_sliver(icosphere(3).mesh, degrees)])
    exact = dense_values(a, b)
    for k in (1, 4, 30):
        system = eigenpairs(a, b, k, method)
        assert_certified(system, a, b, k)
        assert np.abs(system.values - exact[:k]).max() <= 1e-7 * max(exact[k], system.spacing)


@pytest.mark.parametrize(
    ("degrees", "k"), [([0.311753770166146, 1.5973302977204443e-05, 0.00012443893874562812], 135), ([1.363e-05], 31)]
)
def test_an_edge_stays_in_its_narrow_gap(degrees: list[float], k: int) -> None:
    body = icosphere(3).mesh
    for angle in degrees:
        body = with_sliver(body, angle)
    a, b = pencil_of([body])
    assert_certified(eigenpairs(a, b, k, "slicing"), a, b, k)


def test_a_shift_on_an_eigenvalue_moves_within_its_room() -> None:
    a, b = pencil_of([icosphere(2).mesh])
    pencil = ShiftedPencil(a, b)
    value = float(dense_values(a, b)[30])
    for room in (1e-3, 1e-5):
        assert abs(pencil.factor(value, room=room * value)[0] - value) < room * value
    assert abs(pencil.factor(value)[0] - value) < 1e-2 * value


def test_the_seam_of_two_dense_solutions_repeats_no_vector() -> None:
    body = with_sliver(icosphere(2).mesh, 1e-4)
    a, b = pencil_of([body])
    values, vectors = dense.dense_pairs(a.toarray()[None], b.toarray()[None], 1e-8, 1.0)
    overlaps = np.abs(vectors[0].T @ (b @ vectors[0]) - np.eye(len(values[0])))
    assert overlaps.max() < 1e-8


@pytest.mark.parametrize("count", [1, 3, 9])
def test_fewer_vectors_than_lanes_are_measured_without_a_warning(count: int) -> None:
    stiffness, mass = csr_array(diags_array(np.arange(12.0))), csr_array(diags_array(np.ones(12)))
    with np.errstate(all="raise"):
        measurement = measure(stiffness, mass, np.eye(12)[:, :count].copy(order="F"))
    assert (measurement.values == np.arange(count)).all() and (measurement.errors == 0).all()


def test_hundreds_of_tiny_components_beside_a_large_one() -> None:
    tiny = [scaled(icosphere(0).mesh, 0.01 * (1 + i % 7)) for i in range(300)]
    a, b = pencil_of([icosphere(3).mesh, *tiny])
    system = eigenpairs(a, b, 310)
    assert_certified(system, a, b, 310)
    assert (np.abs(system.values) < 1e-6).sum() == 301
    assert system.values[301:304] == pytest.approx(eigenpairs(*pencil_of([icosphere(3).mesh]), 4).values[1:], rel=1e-8)
    assert all((np.abs(vector) > 0).sum() in (12, 642) for vector in system.vectors.T)


def broken(kind: str) -> Matrices:
    a, b = pencil_of([icosphere(3).mesh])
    a, b = a.tolil(), b.tolil()
    match kind:
        case "nan":
            a[3, 3] = np.nan
        case "zero mass":
            b[5, 5] = 0.0
        case "indefinite mass":
            b[5, 6] = b[6, 5] = 10.0 * b[5, 5]
            b[5, 6] = b[6, 5] = 10.0 * b[5, 5]
        case "opposite sign":
            a = -a
        case "indefinite stiffness":
            a[7, 7] -= 1.2 * a[7, 7]
            a[7, 7] += 1.0 * a[6, 6]
        case "singular":
            a[9, :] = a[:, 9] = b[9, :] = b[:, 9] = 0.0
        case "not symmetric":
            a[0, 1] += 1.0
    return csr_array(a), csr_array(b)


@pytest.mark.parametrize("method", ["auto", "slicing", "dense", "arpack"])
@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("nan", "stiffness matrix has 1 entries that are not finite: repair"),
        ("zero mass", "mass of degree of freedom 5 is 0, must be positive: repair"),
        ("indefinite mass", "mass matrix is not positive definite"),
        ("opposite sign", "take -A"),
        ("singular", "mass of degree of freedom 9 is 0"),
        ("not symmetric", "not symmetric, by 1"),
    ],
)
def test_unfit_matrices_have_one_refusal(kind: str, words: str, method: str) -> None:
    a, b = broken(kind)
    for k in (1, 10):
        with pytest.raises(EigensolverError, match=words):
            eigenpairs(a, b, k, method)


@pytest.mark.parametrize("method", ["auto", "slicing", "dense", "arpack"])
@pytest.mark.parametrize("k", [1, 10, 40])
def test_an_indefinite_stiffness_is_named(method: str, k: int) -> None:
    a, b = pencil_of([icosphere(3).mesh])
    with pytest.raises(EigensolverError, match="positive semidefinite"):
        eigenpairs(csr_array(a - 30.0 * b), b, k, method)


def test_indefinite_matrices_of_several_components_are_named() -> None:
    a, b = copies(5, 0.0)
    with pytest.raises(EigensolverError, match="positive semidefinite"):
        eigenpairs(csr_array(a - 30.0 * b), b, 10)
    heavy = b.tolil()
    heavy[5, 6] = heavy[6, 5] = 10.0 * b[5, 5]
    with pytest.raises(EigensolverError, match="mass matrix is not positive definite"):
        eigenpairs(a, csr_array(heavy), 10)


def test_by_how_much_a_small_mass_is_indefinite_is_said() -> None:
    mass = np.array([[[4.0, 6.0], [6.0, 4.0]]])
    with pytest.raises(EigensolverError, match=r"its least eigenvalue at unit diagonal is -5\.0e-01"):
        dense_pairs(np.eye(2)[None], mass, 1e-8, 1.0)


def test_an_isolated_row_with_a_mass_is_a_component_of_its_own() -> None:
    a, b = pencil_of([disk(6).mesh])
    a = csr_array(np.pad(a.toarray(), (0, 1)))
    b = csr_array(np.pad(b.toarray(), (0, 1)) + np.diag(np.append(np.zeros(b.shape[0]), 0.1)))
    system = eigenpairs(a, b, 3)
    assert_certified(system, a, b, 3)
    assert (np.abs(system.values[:2]) < 1e-12).all() and np.abs(system.vectors[-1]).max() == pytest.approx(0.1**-0.5)


def test_dense_algebra_that_loses_a_pair_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    a, b = pencil_of([disk(8).mesh])
    whole = dense.dense_pairs

    def without_the_fifth(*arguments):
        values, vectors = whole(*arguments)
        return np.delete(values, 5, axis=1), np.delete(vectors, 5, axis=2)

    monkeypatch.setattr(dense, "dense_pairs", without_the_fifth)
    assert eigenpairs(a, b, 4, "dense").complete
    with pytest.raises(EigensolverError, match="does not prove them the lowest"):
        eigenpairs(a, b, 12, "dense")


@pytest.mark.parametrize("change", ["missing", "repeated"])
def test_a_component_that_loses_a_pair_is_refused(change: str, monkeypatch: pytest.MonkeyPatch) -> None:
    a, b = copies(3, 0.0)
    whole = components.dense_pairs

    def damaged(*arguments):
        values, vectors = whole(*arguments)
        if change == "repeated":
            vectors[1, :, 2], values[1, 2] = vectors[1, :, 1], values[1, 1]
            return values, vectors
        return np.delete(values, 2, axis=1), np.delete(vectors, 2, axis=2)

    monkeypatch.setattr(components, "dense_pairs", damaged)
    with pytest.raises(EigensolverError, match=r"does not prove|proves them different"):
        eigenpairs(a, b, 12)


def test_a_slice_that_loses_a_pair_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    a, b = pencil_of([disk(14).mesh])
    whole = eigensolver.slicing

    def without_the_last(*arguments) -> EigenSystem:
        system = whole(*arguments)
        return replace(system, values=system.values[:-1], vectors=system.vectors[:, :-1])

    monkeypatch.setattr(eigensolver, "slicing", without_the_last)
    with pytest.raises(EigensolverError, match="29 of k = 30"):
        eigenpairs(a, b, 30, "slicing")


def rounding_floor(system: EigenSystem, a: csr_array, b: csr_array) -> float:
    """The largest relative residual that rounding each entry of the vectors by one unit can leave."""
    sizes = np.abs(system.vectors)
    entries = abs(a) @ sizes + (b @ sizes) * np.abs(system.values)
    errors = np.finfo(float).eps * np.linalg.norm(entries, axis=0)
    relative = errors / np.linalg.norm(b @ system.vectors, axis=0) / np.maximum(np.abs(system.values), system.spacing)
    return float(relative.max())


def check_drawn(pencil: Pencil, k: int, method: str = "auto") -> None:
    """Solve, or be refused for a residual that is rounding: of slivers that no vector of doubles can do better for."""
    a, b = pencil.stiffness, pencil.mass
    tolerance = 1e-8
    try:
        system = eigenpairs(a, b, k, method)
    except EigensolverError as refusal:
        assert "has residual" in str(refusal)
        tolerance = float(str(refusal).rsplit("or tolerance ", 1)[1])
        system = eigenpairs(a, b, k, method, tolerance)
        assert rounding_floor(system, a, b) > 0.5e-8
    assert_certified(system, a, b, k, tolerance)
    assert_equal(system, pencil)
    for shift, count in system.inertia:
        apart = np.abs(pencil.values - shift).min() > 1e-7 * max(shift, system.spacing)
        assert not apart or count == (pencil.values < shift).sum()


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(pencils_and_counts())
def test_drawn_pencils_equal_dense_algebra(drawn: tuple[Pencil, int]) -> None:
    check_drawn(*drawn)


@pytest.mark.slow
@settings(max_examples=500, deadline=None, suppress_health_check=list(HealthCheck))
@given(pencils_and_counts())
def test_five_hundred_drawn_pencils_equal_dense_algebra(drawn: tuple[Pencil, int]) -> None:
    check_drawn(*drawn)


@pytest.mark.parametrize("pair", [0, 1, 2])
def test_one_pair_beyond_the_tolerance_is_refused_by_number(pair: int) -> None:
    residuals = np.full(3, 1e-12)
    residuals[pair] = 1e-3
    system = EigenSystem(np.array([0.0, 1.0, 2.0]), np.eye(3), residuals, 0.0, True, ((2.5, 3),), spacing=1.0)
    with pytest.raises(EigensolverError, match=f"pair {pair} has residual 1.0e-03, above tolerance 1e-08"):
        certified(system, 3, 1e-8)
    assert certified(system, 3, 1e-2) is system


def test_a_diagonal_mass_needs_no_factorisation() -> None:
    a, b = pencil_of([icosphere(3).mesh])
    lumped = csr_array(diags_array(b.sum(axis=1)))
    assert_certified(eigenpairs(a, lumped, 20), a, lumped, 20)
