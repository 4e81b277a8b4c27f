"""Heat flow by a polynomial: the steps of a factorisation to rounding, and none where the polynomial would be long."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import surfexp as sx
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.variational import short_heat_flow as module
from surfexp.variational.noise_statistics import NoiseStatistics
from surfexp.variational.short_heat_flow import LARGEST_DEGREE, ShortHeatFlow, series_of_steps
from surfexp.variational.surface_flows import heat_flow

BALL = sx.shape("icosphere", levels=3).mesh
NOISE = np.random.default_rng(0).standard_normal((len(BALL.vertices), 2))


@given(st.floats(0.1, 6.0), st.integers(1, 12), st.floats(0.3, 1.0))
def test_it_is_that_of_the_factorised_steps(width: float, steps: int, squeezed: float) -> None:
    operator = fem(TriangleMesh(BALL.vertices * [1.0, 1.0, squeezed], BALL.faces))
    time = (width * operator.edge_length) ** 2 / (16.0 * np.log(2.0))
    assert np.abs(ShortHeatFlow(operator, time, steps)(NOISE) - heat_flow(operator, NOISE, time, steps)).max() < 1e-12


@pytest.mark.parametrize("half", [1e-6, 0.3, 5.0, 15.0])
def test_the_series_is_the_function(half: float) -> None:
    found = series_of_steps(half, 4)
    assert found is not None
    x = np.linspace(-1.0, 1.0, 501)
    assert np.abs(np.polynomial.chebyshev.chebval(x, found) - (1.0 + half * (1.0 + x)) ** -4).max() < 1e-12
    assert len(found) <= 1 + LARGEST_DEGREE


def test_slivers_are_factorised_and_once(monkeypatch: pytest.MonkeyPatch) -> None:
    flat = fem(TriangleMesh(BALL.vertices * [1.0, 1.0, 1e-4], BALL.faces))
    called = []
    monkeypatch.setattr(module, "ldlt", lambda matrix: called.append(matrix) or ldlt(matrix))
    statistics = NoiseStatistics(flat)
    for _ in range(3):
        statistics.smooth_noise(NOISE, 4.0)
        statistics.local_level(np.ones(len(statistics.relations[0])), np.ones(len(statistics.relations[0]), dtype=bool))
    assert len(called) == 1 and series_of_steps(1e6, 4) is None
    flow = ShortHeatFlow(flat, flat.edge_length**2)
    assert np.abs(flow(NOISE) - heat_flow(flat, NOISE, flat.edge_length**2)).max() < 1e-12


def test_far_from_all_pairs_that_are_used_the_level_is_that_of_the_nearest() -> None:
    ball = sx.shape("icosphere", levels=5).mesh
    statistics = NoiseStatistics(fem(ball))
    used = (ball.vertices[statistics.relations[0]][:, :, 2] > 0.98).all(axis=1)
    levels = statistics.local_level(np.ones(len(used)), used)
    assert np.ptp(levels) < 1e-6 * levels.mean()
