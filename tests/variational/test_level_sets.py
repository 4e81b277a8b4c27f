"""Co-area formula and perimeters."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.variational.level_sets import perimeters

OPERATOR = fem(icosphere(3).mesh)


@settings(deadline=None, max_examples=10)
@given(st.integers(0, 10**6))
def test_coarea_formula_is_exact(seed: int) -> None:
    """Between neighbouring values the perimeter is linear in t, so midpoints integrate it exactly."""
    values = np.random.default_rng(seed).normal(size=OPERATOR.vertex_count)
    knots = np.unique(values)
    middles = 0.5 * (knots[1:] + knots[:-1])
    integral = perimeters(OPERATOR, values, middles) @ np.diff(knots)
    assert integral == pytest.approx(total_variation(OPERATOR, values), rel=1e-12)


def test_perimeter_is_that_of_the_polygon() -> None:
    mesh = icosphere(3).mesh
    values, level = mesh.vertices[:, 2], 0.31
    length = 0.0
    for corners in mesh.vertices[mesh.faces]:
        points = []
        for k in range(3):
            a, b = corners[k], corners[k - 1]
            if (a[2] - level) * (b[2] - level) < 0:
                points.append(a + (level - a[2]) / (b[2] - a[2]) * (b - a))
        if len(points) == 2:
            length += float(np.linalg.norm(points[0] - points[1]))
    assert perimeters(OPERATOR, values, np.array([level]))[0] == pytest.approx(length, rel=1e-12)
    assert length == pytest.approx(2 * np.pi * np.sqrt(1 - level**2), rel=5e-3)


def test_nodal_indicator_overstates_the_perimeter_and_a_ramp_does_not() -> None:
    exact = 2 * np.pi * np.sin(1.0)
    for levels in (4, 5):
        operator, mesh = fem(icosphere(levels).mesh), icosphere(levels).mesh
        polar = np.arccos(np.clip(mesh.vertices[:, 2], -1, 1))
        assert 1.08 < total_variation(operator, (polar < 1.0).astype(float)) / exact < 1.26
        ramp = np.clip(0.5 + (1.0 - polar) / np.sqrt(operator.edge_length), 0, 1)
        assert abs(total_variation(operator, ramp) / exact - 1) < 0.018
