"""What `complete` and a residual say: a slice that is not counted out, or a vector that is no eigenvector, is no proof."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.lab.store.kinds import KINDS
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.spectrum import single_slice, slicing
from surfexp.spectrum.eigensolver_error import EigensolverError
from surfexp.spectrum.shifted_pencil import ShiftedPencil
from surfexp.spectrum.spectrum_range import _proved, pairs_between

OPERATOR, FINE = fem(icosphere(3).mesh), fem(icosphere(4).mesh)


def pencil() -> ShiftedPencil:
    return ShiftedPencil(stiffness(OPERATOR), mass_matrix(OPERATOR))


@pytest.mark.parametrize("unproved", [0, 1])
def test_one_slice_that_is_not_proved_leaves_the_whole_unproved(unproved: int, monkeypatch: pytest.MonkeyPatch) -> None:
    solved = single_slice.solve_slice
    count = 0

    def doubted(*given, **more):
        nonlocal count
        found = solved(*given, **more)
        count += 1
        return replace(found, complete=found.complete and count - 1 != unproved)

    monkeypatch.setattr(slicing, "ALONE", 1000)
    monkeypatch.setattr(single_slice, "solve_slice", doubted)
    found = slicing.slicing(stiffness(FINE), mass_matrix(FINE), 400)
    assert count > unproved and not found.complete


def test_vectors_that_are_no_eigenvectors_prove_no_window() -> None:
    some = pencil()
    edges = tuple(some.factor(value)[0] for value in (1.0, 4.0))
    vectors = np.asfortranarray(np.random.default_rng(0).normal(size=(some.size, 3)))
    vectors /= np.sqrt(np.einsum("nk,nk->k", vectors, some.mass @ vectors))
    with pytest.raises(EigensolverError, match=r"pair \d has residual .*, above tolerance 1e-08"):
        _proved(some, vectors, edges, 1e-8)


def test_a_window_names_the_counts_at_its_own_ends() -> None:
    found = pairs_between(pencil(), 1.0, 13.0, 1e-8)
    for edge, below in found.inertia:
        assert below == (found.values < edge).sum() + 1  # the constant lies below the window
    assert len(found.values) == found.inertia[-1][1] - found.inertia[0][1] == 15


def test_one_eigenvector_twice_proves_no_window() -> None:
    some = pencil()
    edges = tuple(some.factor(value)[0] for value in (1.0, 4.0))
    vectors = np.asfortranarray(pairs_between(some, 1.0, 4.0).vectors[some.order][:, [0, 1, 1]])
    with pytest.raises(EigensolverError, match=r"orthogonal to 1\.0e\+00, at most 1e-08"):
        _proved(some, vectors, edges, 1e-8)


def test_a_window_moves_its_shift_where_orthogonality_was_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    solved, shifts = single_slice.solve_slice, []
    plain = pairs_between(pencil(), 1.0, 13.0)

    def drifting(some, shift, *given):
        shifts.append(shift)
        return replace(solved(some, shift, *given), drift=1.0 if len(shifts) == 1 else 0.0)

    monkeypatch.setattr(single_slice, "solve_slice", drifting)
    moved = pairs_between(pencil(), 1.0, 13.0)
    assert len(set(shifts)) == len(shifts) > 1
    np.testing.assert_allclose(moved.values, plain.values, rtol=1e-10)


def test_tables_say_of_complete_that_it_is_a_proof() -> None:
    load_all(Path("/nonexistent"))
    declared = [KINDS["eigensolver"].result.METRICS, *(plugin.metrics for plugin in registry.PLUGINS.values())]
    meanings = {metrics["complete"].meaning for metrics in declared if "complete" in metrics}
    assert len(meanings) >= 3 and all(meaning.startswith("1 where it is proved ") for meaning in meanings)
