"""Masks: cutting, restricting, extending."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface_part import finite_mask, surface_part

MESH = icosphere(2).mesh
N = len(MESH.vertices)


@given(st.lists(st.booleans(), min_size=N, max_size=N))
def test_faces_of_the_part_are_those_inside(mask: list[bool]) -> None:
    inside = np.array(mask)
    kept = MESH.faces[inside[MESH.faces].all(axis=1)]
    if not len(kept):
        with pytest.raises(ValueError, match="no whole face"):
            surface_part(MESH, inside)
        return
    part = surface_part(MESH, inside)
    assert np.array_equal(part.vertices[part.mesh.faces], kept)
    assert np.array_equal(part.mesh.vertices, MESH.vertices[part.vertices])
    values = np.random.default_rng(0).standard_normal((N, 2))
    back = part.extend(part.restrict(values))
    assert np.array_equal(np.isfinite(back[:, 0]), np.isin(np.arange(N), part.vertices))
    assert np.array_equal(back[part.vertices], values[part.vertices])


def test_no_mask_is_the_mesh_itself() -> None:
    for mask in (None, np.ones(N, bool), np.ones(N)):
        part = surface_part(MESH, mask)
        assert part.mesh is MESH and part.is_whole and part.notes == ()


def test_what_a_mask_cuts_off_is_said() -> None:
    equator = np.abs(MESH.vertices[:, 2]) > 0.35
    notes = " ".join(surface_part(MESH, equator).notes)
    assert "2 components" in notes
    lonely = np.zeros(N, bool)
    lonely[MESH.faces[0]] = lonely[MESH.faces[-1][0]] = True
    assert "1 of 4 vertices" in " ".join(surface_part(MESH, lonely).notes)


def test_masks_that_are_unfit_are_refused() -> None:
    for mask, words in ((np.ones(3), "shape"), (np.full(N, np.nan), "no whole face"), (np.zeros(N), "no whole face")):
        with pytest.raises(ValueError, match=words):
            surface_part(MESH, mask)
    with pytest.raises(ValueError, match="2 infinite values"):
        finite_mask([np.array([np.inf, 1.0, -np.inf])], 3)
    assert finite_mask([np.ones(3)], 3) is None
    assert np.array_equal(finite_mask([np.array([[1.0, np.nan], [1.0, 2.0]])], 2), [False, True])
