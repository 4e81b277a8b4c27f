"""Slices side by side: the same bytes for any number of threads, complete, and given up where one of them proves nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse import csr_array, diags_array

import surfexp as sx
from surfexp.contract.threads import in_threads
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum import side_by_side
from surfexp.spectrum.eigensystem import EigenSystem, measure
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.slicing import slicing

TORUS = fem(torus(64, 28, jitter=0.2).mesh)
A, B = stiffness(TORUS), mass_matrix(TORUS)
COUNT = 320


def bytes_of(system: EigenSystem) -> tuple[bytes, ...]:
    arrays = (system.values, system.vectors, system.residuals, np.array(system.inertia))
    return (*(array.tobytes() for array in arrays), repr((system.orthogonality, system.metrics)).encode())


@pytest.fixture(scope="module")
def alone() -> EigenSystem:
    return slicing(A, B, COUNT)


@pytest.mark.parametrize("threads", [2, 4])
def test_the_bytes_are_those_of_one_thread(alone: EigenSystem, threads: int) -> None:
    assert alone.metrics["slices"] == 3
    assert bytes_of(slicing(A, B, COUNT, threads=threads)) == bytes_of(alone)


def test_no_pair_is_missing(alone: EigenSystem) -> None:
    exact = eigh(A.toarray(), B.toarray(), eigvals_only=True, subset_by_index=(0, COUNT - 1))
    assert alone.complete and alone.orthogonality < 1e-8
    assert np.abs(alone.values - exact).max() < 1e-8 * exact[-1]
    assert all(below == (exact < edge).sum() for edge, below in alone.inertia[:-1])


def test_an_edge_between_two_nearly_equal_values_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """Values 1 to 700 in pairs 1e-7 apart, with an edge between those of number 75."""
    values = np.repeat(np.arange(1.0, 701.0), 2)
    values[1::2] += 1e-7
    joined = diags_array([values, np.full(len(values) - 1, 1e-9), np.full(len(values) - 1, 1e-9)], offsets=[0, 1, -1])
    monkeypatch.setattr(side_by_side, "guess_eigenvalue", lambda *_: 75.0 + 5e-8)
    system = slicing(csr_array(joined), csr_array(diags_array(np.ones(len(values)))), 300)
    assert 75.0 + 5e-8 not in dict(system.inertia)
    assert system.complete and system.orthogonality < 1e-8
    assert system.values == pytest.approx(values[:300], rel=1e-9)


@pytest.mark.parametrize("doubtful", [0, 1, 2])
def test_a_slice_without_proof_leaves_the_work_to_slices_in_turn(
    doubtful: int, monkeypatch: pytest.MonkeyPatch, alone: EigenSystem
) -> None:
    solved, calls = side_by_side.solve_at_good_shift, []

    def doubted(*given):
        part = solved(*given)
        calls.append(given[2])
        return replace(part, complete=part.complete and len(calls) - 1 != doubtful)

    monkeypatch.setattr(side_by_side, "solve_at_good_shift", doubted)
    system = slicing(A, B, COUNT)
    assert len(calls) == 3 and system.complete and system.metrics["slices"] == 1
    np.testing.assert_allclose(system.values, alone.values, atol=1e-9 * alone.values[-1])


def test_a_value_too_near_to_the_lower_edge_is_no_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    solved = side_by_side.solve_at_good_shift

    def doubtful(own, found, count, freedom, low, *given):
        if found:
            own.doubts[low] = 1e3
        return solved(own, found, count, freedom, low, *given)

    monkeypatch.setattr(side_by_side, "solve_at_good_shift", doubtful)
    parts = side_by_side.slices_side_by_side(ShiftedPencil(A, B), COUNT, 1e-8, 0, 1)
    assert [part.complete for part in parts] == [True, False, False]


def test_progress_counts_the_pairs_of_all_slices() -> None:
    seen: list[tuple[int, float]] = []
    slicing(A, B, COUNT, progress=lambda found, missing: seen.append((found, missing)), threads=2)
    assert [found for found, _ in seen] == sorted(found for found, _ in seen)
    assert seen[-1][0] >= COUNT and seen[-1][1] == 0.0


def test_measures_of_vectors_have_the_same_bytes(alone: EigenSystem) -> None:
    one, three = (measure(csr_array(A), csr_array(B), alone.vectors, threads=threads) for threads in (1, 3))
    for name in ("values", "errors", "overlaps"):
        assert getattr(one, name).tobytes() == getattr(three, name).tobytes()


def test_python_calls_give_the_same_bytes() -> None:
    ball = icosphere(4).mesh
    surface = (ball.vertices, ball.faces)
    one, two = (sx.eigenpairs(surface, 240, threads=threads) for threads in (1, 2))
    assert bytes_of(one) == bytes_of(two)
    assert sx.Spectrum(surface, threads=2).first(240).vectors.tobytes() == one.vectors.tobytes()
    a, b = (sx.eigsh(A, COUNT, B, sigma=-0.01, threads=threads)[1].tobytes() for threads in (1, 2))
    assert a == b


@pytest.mark.parametrize("threads", [0, -1, 1.5, "two"])
def test_no_number_of_threads_is_refused(threads: object) -> None:
    for call in (
        lambda: sx.eigenpairs(sx.shape("icosphere", levels=1), 3, threads=threads),  # type: ignore[arg-type]
        lambda: sx.eigsh(A, 3, B, sigma=0.0, threads=threads),  # type: ignore[arg-type]
        lambda: sx.Spectrum(sx.shape("icosphere", levels=1), threads=threads),  # type: ignore[arg-type]
        lambda: sx.denoise(sx.shape("icosphere", levels=1), np.arange(42.0), threads=threads),  # type: ignore[arg-type]
        lambda: sx.segment(sx.shape("icosphere", levels=1), np.arange(42.0), threads=threads),  # type: ignore[arg-type]
    ):
        with pytest.raises(ValueError, match=r"threads = .*, at least 1 is needed"):
            call()


def test_answers_come_in_order_and_an_error_comes_out() -> None:
    assert list(in_threads(lambda n: n * n, range(20), 3)) == [n * n for n in range(20)]
    with pytest.raises(ZeroDivisionError):
        list(in_threads(lambda n: 1 // n, [1, 0, 1], 2))
