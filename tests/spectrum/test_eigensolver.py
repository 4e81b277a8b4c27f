"""The eigensolvers against dense algebra, exact spectra and one another; the certificate against planted gaps."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse import block_diag, csr_array, diags_array

from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum import spectrum_slice
from surfexp.spectrum.dense import dense
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import clusters
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.slicing import polish, slicing


def pencil(mesh: TriangleMesh, lumped: bool = False) -> tuple[csr_array, csr_array]:
    operator = fem(mesh)
    mass = csr_array(diags_array(operator.mass)) if lumped else mass_matrix(operator)
    return stiffness(operator), mass


def assert_pairs(system, a, b, k: int, tolerance: float = 1e-8) -> None:
    assert system.values.shape == (k,) and system.vectors.shape == (a.shape[0], k)
    assert np.all(np.diff(system.values) >= -1e-9 * system.values[-1])
    assert system.residuals.max() <= tolerance
    gram = system.vectors.T @ (b @ system.vectors)
    cut = any("cuts a cluster" in note for note in system.notes)
    largest = np.abs(gram - np.eye(k)).max()
    assert largest <= system.orthogonality + 1e-12 and (cut or largest >= system.orthogonality - 1e-12)
    assert system.orthogonality <= 1e-8
    scale = np.maximum(np.abs(system.values), system.spacing)
    error = a @ system.vectors - (b @ system.vectors) * system.values
    assert np.allclose(
        system.residuals, np.linalg.norm(error, axis=0) / np.linalg.norm(b @ system.vectors, axis=0) / scale, atol=1e-13
    )


@pytest.mark.parametrize("lumped", [False, True])
@pytest.mark.parametrize(
    "mesh", [icosphere(3).mesh, disk(16).mesh, torus(40, 18, jitter=0.2).mesh], ids=["sphere", "disk", "torus"]
)
def test_slicing_equals_dense_algebra(mesh: TriangleMesh, lumped: bool) -> None:
    a, b = pencil(mesh, lumped)
    system = eigenpairs(a, b, 60, "slicing")
    exact = eigh(a.toarray(), b.toarray(), eigvals_only=True)
    assert system.complete and len(system.inertia) >= 1
    assert_pairs(system, a, b, 60)
    assert np.abs(system.values - exact[:60]).max() < 1e-9 * exact[60]
    for shift, count in system.inertia:
        assert (exact < shift).sum() == count


def test_methods_agree() -> None:
    ball = icosphere(3).mesh
    a, b = pencil(TriangleMesh(ball.vertices * [1.3, 1.0, 0.7], ball.faces))
    reference = eigenpairs(a, b, 20, "dense")
    for method, tolerance in (("slicing", 1e-8), ("arpack", 1e-8), ("lobpcg", 1e-5)):
        system = eigenpairs(a, b, 20, method, tolerance)
        assert system.method == method and system.complete == (method != "lobpcg")
        assert_pairs(system, a, b, 20, tolerance)
        assert np.allclose(system.values, reference.values, atol=1e-7)
        simple = [i for i in range(20) if not any(s <= i < t for s, t in clusters(reference.values, 1e-3))]
        assert len(simple) > 10
        assert np.abs(system.vectors[:, simple] - reference.vectors[:, simple]).max() < 1e-3


@pytest.mark.parametrize("package", ["pyamg", None])
def test_lobpcg_reaches_its_tolerance_with_either_preconditioner(
    package: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    if package:
        pytest.importorskip(package)
    else:
        monkeypatch.setitem(sys.modules, "pyamg", None)
    a, b = pencil(torus(60, 24).mesh)
    system = eigenpairs(a, b, 12, "lobpcg", 1e-5)
    assert system.residuals.max() < 1e-5 and not system.complete
    assert ("multigrid" if package else "incomplete LU") in system.notes[0] and len(system.notes) == 1
    assert system.values[1:] == pytest.approx(eigenpairs(a, b, 12).values[1:], rel=1e-8)


def test_many_slices_stay_orthogonal_and_complete(monkeypatch: pytest.MonkeyPatch) -> None:
    a, b = pencil(icosphere(4).mesh)
    monkeypatch.setattr("surfexp.spectrum.slicing.SLICE", 40)
    system = slicing(a, b, 150)
    assert system.metrics["slices"] >= 4 and system.complete
    assert_pairs(system, a, b, 150)
    exact = eigh(a.toarray(), b.toarray(), eigvals_only=True, subset_by_index=(0, 149))
    assert np.abs(system.values - exact).max() < 1e-8 * exact[-1]


def test_every_component_has_its_zero_mode_even_beyond_the_block_size() -> None:
    a, b = pencil(icosphere(2).mesh)
    a, b = csr_array(block_diag([a] * 21)), csr_array(block_diag([b] * 21))
    system = eigenpairs(a, b, 21 * 4 + 3, "slicing")
    assert system.complete and (np.abs(system.values) < 1e-9).sum() == 21
    assert np.ptp(system.values[21:84]) < 1e-8
    assert system.clusters[0] == (0, 21) and system.clusters[1] == (21, 84)
    assert_pairs(system, a, b, 87)
    assert any("cuts a cluster" in note and "k = 189" in note for note in system.notes)


@pytest.mark.parametrize("lost", [0, 7, -1])
def test_a_pair_that_lanczos_lost_is_found_by_starting_again(lost: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """The count at the edge tells that one is missing; the shift is factorised again, and one more search finds it."""
    a, b = pencil(torus(40, 18, jitter=0.2).mesh)
    whole = eigenpairs(a, b, 60, "slicing")
    iterate, calls = spectrum_slice._iterate, []

    def forgetful(*arguments):
        values, vectors = iterate(*arguments)
        calls.append(len(values))
        return (np.delete(values, lost), np.delete(vectors, lost, axis=1)) if len(calls) == 1 else (values, vectors)

    monkeypatch.setattr(spectrum_slice, "_iterate", forgetful)
    system = eigenpairs(a, b, 60, "slicing")
    assert calls == [61, 1] and system.complete
    assert_pairs(system, a, b, 60)
    np.testing.assert_allclose(system.values, whole.values, atol=1e-9 * whole.values[-1])


def test_only_pairs_that_miss_the_tolerance_are_polished() -> None:
    a, b = pencil(torus(40, 18, jitter=0.2).mesh)
    shifted = ShiftedPencil(a, b)
    exact = eigenpairs(a, b, 60).vectors[shifted.order]
    kept = exact.copy()
    assert polish(shifted, kept, 1e-8)[1] == 0 and np.array_equal(kept, exact)
    rough = exact.copy()
    rough[:, :4] += 1e-8 * np.random.default_rng(0).normal(size=rough[:, :4].shape)
    measurement, rounds = polish(shifted, rough, 1e-8)
    assert rounds >= 1 and measurement.residuals.max() <= 1e-8


def test_thin_tube_where_weyls_law_is_far_off() -> None:
    mesh = torus(600, 6, major_radius=100.0, minor_radius=0.5).mesh
    a, b = pencil(mesh)
    system = eigenpairs(a, b, 70, "slicing")
    assert system.complete
    assert_pairs(system, a, b, 70)
    m = np.arange(1, 36).repeat(2)[:69]
    assert np.allclose(system.values[1:], (m / 100.0) ** 2, rtol=2e-2)


def test_dirichlet_and_scaled_surfaces() -> None:
    a, b = pencil(disk(20).mesh)
    inner = np.flatnonzero(np.arange(a.shape[0]) < 1 + 3 * 19 * 20)
    a, b = a[inner][:, inner], b[inner][:, inner]
    unit = eigenpairs(a, b, 50, "slicing")
    large = eigenpairs(a, 1e6 * b, 50, "slicing")
    assert unit.complete and large.complete
    assert unit.values[0] == pytest.approx(2.404825557695773**2, rel=6e-3)
    assert np.allclose(large.values * 1e6, unit.values, rtol=1e-9)


def test_a_planted_gap_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    a, b = pencil(disk(14).mesh)
    truth = eigenpairs(a, b, 30, "dense")
    assert not any(start <= 5 < stop for start, stop in clusters(truth.values, 1e-3))
    hidden = truth.vectors[:, 5]

    def blinded(self: ShiftedPencil, block: np.ndarray, result: np.ndarray | None = None) -> np.ndarray:
        result = np.ascontiguousarray(self.mass @ block)
        weight = self.mass @ hidden[self.order]
        return result - np.outer(weight, weight @ block)

    monkeypatch.setattr(ShiftedPencil, "multiply_mass", blinded)
    system = slicing(a, b, 30)
    assert not system.complete
    assert np.abs(system.values - truth.values[5]).min() > 1e-3 * truth.values[5]
    assert any("not complete" in note for note in system.notes)


def test_the_result_is_the_same_to_the_byte() -> None:
    a, b = pencil(icosphere(3).mesh)
    one, two = eigenpairs(a, b, 40, "slicing"), eigenpairs(a, b, 40, "slicing")
    assert np.array_equal(one.values, two.values) and np.array_equal(one.vectors, two.vectors)


def test_progress_reports_the_pairs_found() -> None:
    a, b = pencil(icosphere(3).mesh)
    seen: list[tuple[int, float]] = []
    eigenpairs(a, b, 40, "slicing", progress=lambda found, missing: seen.append((found, missing)))
    assert seen[-1][0] >= 40 and seen[-1][1] == 0.0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"k": 700}, "k = 700 eigenpairs of 642"),
        ({"k": 0}, "k = 0"),
        ({"k": 300, "method": "arpack"}, "take k <= 160"),
        ({"method": "magic"}, "choose one of auto"),
        ({"tolerance": 1.0}, "between 1e-12 and 1e-2"),
    ],
)
def test_bad_requests_are_refused(change: dict, words: str) -> None:
    a, b = pencil(icosphere(3).mesh)
    with pytest.raises(ValueError, match=words):
        eigenpairs(**{"stiffness": a, "mass": b, "k": 10, **change})


def test_bad_matrices_are_refused() -> None:
    a, b = pencil(icosphere(3).mesh)
    for bad, words in ((np.nan, "not finite"), (-1.0, "must be positive"), (0.0, "must be positive")):
        broken = b.tolil()
        broken[5, 5] = bad
        with pytest.raises(ValueError, match=words):
            eigenpairs(a, csr_array(broken), 10)
    with pytest.raises(ValueError, match="0 rows"):
        eigenpairs(a[:0][:, :0], b[:0][:, :0], 1)
    with pytest.raises(ValueError, match="one size"):
        eigenpairs(a[:9][:, :9], b, 1)
    for scale in (1.0, 1e-9):
        skewed = (scale * a).tolil()
        skewed[0, 1] += scale
        with pytest.raises(ValueError, match="not symmetric"):
            eigenpairs(csr_array(skewed), b, 5)


@pytest.mark.parametrize("size", [1, 2])
def test_one_and_two_degrees_of_freedom_are_solved(size: int) -> None:
    a, b = (csr_array(matrix[:size][:, :size]) for matrix in pencil(icosphere(3).mesh))
    system = eigenpairs(a, b, size)
    exact = np.sort(np.linalg.eigvals(np.linalg.solve(b.toarray(), a.toarray())).real)
    assert system.complete and system.values == pytest.approx(exact, rel=1e-10)


@pytest.mark.slow
def test_a_thousand_pairs_to_1e_8() -> None:
    a, b = pencil(icosphere(5).mesh)
    system = eigenpairs(a, b, 1000, "slicing")
    assert system.complete
    assert_pairs(system, a, b, 1000)


@pytest.mark.parametrize(
    ("method", "k"),
    [(method, k) for method in ("dense", "slicing") for k in (1, 2, 3, 4)],
)
def test_only_a_cut_cluster_is_said_to_be_cut(method: str, k: int) -> None:
    a, b = pencil(icosphere(2).mesh)  # values 1 to 3 are equal by symmetry
    said = (f"k = {k} cuts a cluster of nearly equal eigenvalues: k = 4 contains all of it",)
    assert eigenpairs(a, b, k, method=method).notes == (said if k in (2, 3) else ())  # type: ignore[arg-type]


def test_a_few_huge_values_hide_no_error_of_the_small_ones() -> None:
    """The spacing that residuals are relative to is that of the pairs asked for, whatever stands at the other end."""
    mesh = icosphere(2).mesh
    stiff, mass = stiffness(fem(mesh)), mass_matrix(fem(mesh))
    huge = stiff.copy().tolil()
    huge[:2, :2] += 1e11 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    dense_result = dense(csr_array(huge), mass, 4)
    exact = dense(stiff, mass, 8).values
    assert dense_result.spacing < exact[7]
    wrong = np.abs(dense_result.values[0]) / dense_result.spacing
    assert dense_result.residuals[0] >= 0.1 * wrong


def test_the_matrices_that_were_given_keep_their_entries() -> None:
    """Unsorted rows in single precision: whoever sorts shared indices moves the caller's entries."""
    given = [csr_array(matrix).astype(np.float32) for matrix in pencil(icosphere(2).mesh, lumped=False)]
    for matrix in given:
        backwards = np.lexsort((-matrix.indices, np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))))
        matrix.data, matrix.indices = matrix.data[backwards], matrix.indices[backwards]
        matrix.has_sorted_indices = matrix.has_canonical_format = False
    before = [(matrix.data.copy(), matrix.indices.copy()) for matrix in given]
    eigenpairs(*given, 3, tolerance=1e-6)
    for matrix, (data, indices) in zip(given, before, strict=True):
        assert np.array_equal(matrix.data, data) and np.array_equal(matrix.indices, indices)
