"""Assembly into compressed rows against sums of triplets, on meshes and on triangle soups."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.assembly import assemble, mass_matrix, stiffness
from surfexp.operators.assembly_pattern import assembly_pattern
from surfexp.operators.fem import fem


def triplets(faces: np.ndarray, local: np.ndarray, count: int) -> np.ndarray:
    rows, columns = faces.repeat(3, axis=1).ravel(), np.tile(faces, 3).ravel()
    return coo_array((local.ravel(), (rows, columns)), shape=(count, count)).toarray()


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10**6), st.integers(3, 12), st.integers(1, 30))
def test_any_soup_is_the_sum_of_its_triplets(seed: int, count: int, size: int) -> None:
    """Edges with one, two or many faces, turned either way, and vertices without a face."""
    random = np.random.default_rng(seed)
    faces = np.array([random.choice(count, 3, replace=False) for _ in range(size)], dtype=np.int64)
    local = random.normal(size=(size, 3, 3))
    matrix = assemble(faces, local, count)
    assert np.abs(matrix.toarray() - triplets(faces, local, count)).max() <= 1e-13 * size
    for row in range(count):
        columns = matrix.indices[matrix.indptr[row] : matrix.indptr[row + 1]]
        assert (np.diff(columns) > 0).all()
    pattern = assembly_pattern(faces, count)
    used = np.isin(np.arange(count), faces)
    assert (pattern.indices[pattern.diagonal[used]] == np.flatnonzero(used)).all()
    assert (pattern.diagonal[~used] == -1).all()


def test_matrices_share_a_pattern_and_no_memory() -> None:
    operator = fem(icosphere(2).mesh)
    left, right = stiffness(operator), mass_matrix(operator)
    right.indices[:] = 0
    assert np.abs(left.sum(axis=1)).max() <= 1e-12 and stiffness(operator).indices.max() > 0
    assert mass_matrix(operator).sum() == pytest.approx(operator.areas.sum(), rel=1e-14)


def test_given_matrices_are_taken_as_they_are() -> None:
    operator = fem(icosphere(1).mesh)
    given = stiffness(operator), mass_matrix(operator)
    bare = replace(operator, matrices=given)
    assert stiffness(bare) is given[0] and mass_matrix(bare) is given[1]
