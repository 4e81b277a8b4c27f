"""Perimeters and the co-area formula by routes that share no gradient."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.variational.level_sets import perimeters
from surfexp_studies.coarea.coarea import (
    integral_of_face_perimeters,
    integral_of_perimeters,
    jump_variation,
    level_line_length,
)

SPHERE = icosphere(3).mesh


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10**6), closed=st.booleans())
def test_total_variation_is_the_integral_of_perimeters(seed: int, closed: bool) -> None:
    mesh = icosphere(2).mesh if closed else disk(6).mesh
    rng = np.random.default_rng(seed)
    values, steps = rng.normal(size=len(mesh.vertices)), rng.integers(0, 9, len(mesh.faces)).astype(float)
    assert integral_of_perimeters(mesh, values) == pytest.approx(total_variation(fem(mesh), values), rel=1e-12)
    assert integral_of_face_perimeters(mesh, steps) == pytest.approx(jump_variation(mesh, steps), rel=1e-12)


def test_level_lines_converge_to_circles_and_agree_with_the_kernel() -> None:
    errors = []
    for level in (2, 3, 4):
        mesh = icosphere(level).mesh
        errors.append(2.0 * np.pi * np.sin(1.1) - level_line_length(mesh, mesh.vertices[:, 2], np.cos(1.1)))
    assert errors[0] > 3.0 * errors[1] > 9.0 * errors[2] > 0.0
    heights = np.random.default_rng(0).normal(size=len(SPHERE.vertices))
    found = [level_line_length(SPHERE, heights, level) for level in (-0.5, 0.2)]
    assert perimeters(fem(SPHERE), heights, np.array([-0.5, 0.2])) == pytest.approx(found, rel=1e-12)


def test_the_boundary_of_a_patch_is_no_jump() -> None:
    mesh = disk(4).mesh
    assert jump_variation(mesh, np.ones(len(mesh.faces))) == 0.0
    one = np.zeros(len(mesh.faces))
    inner = int(np.argmin(np.linalg.norm(mesh.vertices[mesh.faces].mean(axis=1), axis=1)))
    one[inner] = 2.0
    corners = mesh.vertices[mesh.faces[inner]]
    length = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).sum()
    assert jump_variation(mesh, one) == pytest.approx(2.0 * length)
