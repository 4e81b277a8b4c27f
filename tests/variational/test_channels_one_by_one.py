"""A sum over channels: its bound is the sum of theirs, and there is none where one channel has none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.models.channelwise import solve_by_channel
from surfexp.variational.separable_quadratic import rof
from surfexp.variational.solvers.primal_dual import primal_dual

MESH = icosphere(2).mesh
OPERATOR = fem(MESH)
DATA = rof(OPERATOR.mass, MESH.vertices[:, :2] + 0.1, 20.0)


def test_the_gap_of_channels_is_that_of_their_sums() -> None:
    parts = [primal_dual(DATA.channel(c), OPERATOR) for c in range(2)]
    found = solve_by_channel(DATA, OPERATOR, primal_dual)
    assert found.energy == pytest.approx(sum(part.energy for part in parts))
    assert found.lower_bound == pytest.approx(sum(part.lower_bound for part in parts))
    assert found.metrics["gap"] == pytest.approx(found.energy - found.lower_bound)
    assert 0.0 <= found.relative_gap < 1e-3


def test_a_channel_without_a_bound_leaves_none() -> None:
    def unproved(fidelity, operator, start=None):
        found = primal_dual(fidelity, operator)
        return replace(found, lower_bound=None if fidelity.target[0] > 0 else found.lower_bound)

    assert np.ptp(np.sign(DATA.target[0])) > 0
    found = solve_by_channel(DATA, OPERATOR, unproved)
    assert found.lower_bound is None and found.relative_gap is None and "gap" not in found.metrics
