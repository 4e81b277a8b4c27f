"""Level sets of linear functions: lengths, loops, orientation and the co-area formula."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.figures.level_set import level_set
from surfexp.mesh.shapes.disk import disk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh

TORUS = torus(24, 12).mesh
SPHERE = icosphere(2).mesh


def total_variation(mesh: TriangleMesh, values: np.ndarray) -> float:
    """Sum of area times the length of the gradient, by the solution of a 2 x 2 system on each face."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    jacobian = np.stack([b - a, c - a], axis=1)
    steps = np.stack([values[mesh.faces[:, k]] - values[mesh.faces[:, 0]] for k in (1, 2)], axis=1)
    coefficients = np.linalg.solve(jacobian @ jacobian.transpose(0, 2, 1), steps[:, :, None])
    return float(mesh.areas @ np.sqrt((steps * coefficients[:, :, 0]).sum(axis=1)))


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_co_area_formula_is_exact(seed: int) -> None:
    values = np.random.default_rng(seed).normal(size=len(SPHERE.vertices))
    levels = np.sort(values)
    # between two values at vertices the length is linear in the level, so the middle integrates it exactly
    lengths = [level_set(SPHERE, values, level).length for level in 0.5 * (levels[1:] + levels[:-1])]
    assert np.dot(np.diff(levels), lengths) == pytest.approx(total_variation(SPHERE, values), rel=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_loops_on_a_closed_surface_are_closed(seed: int, with_ties: bool) -> None:
    values = np.random.default_rng(seed).normal(size=len(TORUS.vertices))
    if with_ties:
        values = np.round(values)
    line = level_set(TORUS, values, 0.0)
    assert sum(len(chain) - 1 for chain in line.lines) == len(line.segments)
    assert all(chain[0] == chain[-1] for chain in line.lines)


def test_straight_line_on_a_disk_has_the_length_of_the_chord_and_two_ends() -> None:
    mesh = disk(20).mesh
    line = level_set(mesh, mesh.vertices @ [0.6, 0.8, 0.0], 0.28)
    (chain,) = line.lines
    ends = line.points[chain[[0, -1]]]
    assert np.allclose(line.points @ [0.6, 0.8, 0.0], 0.28, atol=1e-14)
    assert line.length == pytest.approx(np.linalg.norm(ends[1] - ends[0]), rel=1e-12)
    assert line.length == pytest.approx(2.0 * np.sqrt(1.0 - 0.28**2), rel=2e-3)


def test_circle_of_latitude_converges_at_second_order() -> None:
    errors = []
    for levels in (2, 3, 4, 5):
        mesh = icosphere(levels).mesh
        errors.append(abs(level_set(mesh, mesh.vertices[:, 2], 0.3).length - 2.0 * np.pi * np.sqrt(0.91)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders.mean() > 1.8


def test_higher_values_are_on_the_left() -> None:
    line = level_set(SPHERE, SPHERE.vertices[:, 2], 0.2)
    start, end = (line.points[line.segments[:, k]] for k in (0, 1))
    left = np.cross(SPHERE.face_normals[line.faces], end - start)
    assert (left[:, 2] > 0.0).all()


def test_level_at_vertices_counts_them_as_above() -> None:
    mesh = TriangleMesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    assert level_set(mesh, np.array([1.0, 1.0, 1.0]), 1.0).length == 0.0
    assert level_set(mesh, np.array([0.0, 1.0, 1.0]), 1.0).length == pytest.approx(np.sqrt(2.0))
    assert level_set(mesh, np.array([0.0, 0.0, 1.0]), 1.0).length == 0.0


def test_nan_carries_no_line_and_lengths_must_agree() -> None:
    values = SPHERE.vertices[:, 2].copy()
    values[SPHERE.vertices[:, 0] > 0.0] = np.nan
    line = level_set(SPHERE, values, 0.1)
    assert 2.0 < line.length < np.pi and len(line.lines) == 1
    with pytest.raises(ValueError, match=r"\(3,\), the mesh has 162"):
        level_set(SPHERE, np.zeros(3), 0.0)
