"""The rules read the right parameter: exact risks of linear filters, and what a probe measures."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfexp.contract.arrays import Floats
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.smoothing.methods import Methods
from surfexp.smoothing.parameter_choice import RULES, SmoothedMaps, smooth_on_grid

MESH = icosphere(4).mesh
OPERATOR = fem(MESH)
TRUTH = 3.0 * MESH.vertices[:, 2]
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)


def shrink(maps: Floats, share: float) -> Floats:
    """The simplest filter, of which everything is known."""
    return share * maps


def measured(seed: int, repetitions: int = 2, noise: float = 1.0) -> Floats:
    """The truth with noise."""
    random = np.random.default_rng(seed)
    return TRUTH[:, None] + noise * random.standard_normal((len(TRUTH), repetitions))


@given(st.integers(0, 2**31), st.sampled_from(SHARES))
def test_the_probe_measures_the_divergence_of_a_multiple_exactly(seed: int, share: float) -> None:
    maps = measured(seed, 1)
    grid = smooth_on_grid(shrink, maps, [share], OPERATOR.mass, 1.0, seed)
    removed = OPERATOR.mass @ ((share - 1.0) * maps[:, 0]) ** 2 / OPERATOR.mass.sum()
    assert grid.removed[0] ** 2 == pytest.approx(removed)
    # the sum of m_i dF_i/dy_i is the share of the area
    assert grid.stein[0] == pytest.approx(removed - 1.0 + 2.0 * share, abs=1e-9)


def test_steins_estimate_is_without_bias_for_every_method() -> None:
    """Mean over 40 draws against the mean of the true errors, within four standard errors."""
    for name in ("heat_flow", "total_variation"):
        differences = []
        for seed in range(40):
            smoother, _ = Methods(MESH, OPERATOR, 1.0).smoother(name)  # type: ignore[arg-type]
            grid = smooth_on_grid(smoother, measured(seed, 1), [0.5], OPERATOR.mass, 1.0, seed)
            error = OPERATOR.mass @ (grid.values[0][:, 0] - TRUTH) ** 2 / OPERATOR.mass.sum()
            differences.append(grid.stein[0] - error)
        spread = np.std(differences, ddof=1) / np.sqrt(len(differences))
        assert abs(np.mean(differences)) < 4.0 * spread, name
        assert spread < 0.02


def test_hold_out_is_the_error_plus_the_noise() -> None:
    maps = measured(0)
    grid = smooth_on_grid(shrink, maps, SHARES, OPERATOR.mass, 1.0)
    for place, share in enumerate(SHARES):
        by_hand = [
            OPERATOR.mass @ (share * maps[:, a] - maps[:, b]) ** 2 / OPERATOR.mass.sum() for a, b in ((0, 1), (1, 0))
        ]
        assert grid.hold_out[place] == pytest.approx(np.mean(by_hand))


def test_all_three_rules_come_near_the_best_parameter() -> None:
    smoother, widths = Methods(MESH, OPERATOR, 1.0).smoother("heat_flow")
    widths = tuple(width / 20.0 for width in widths)
    grid = smooth_on_grid(smoother, measured(1), widths, OPERATOR.mass, 1.0)
    errors = [OPERATOR.mass @ ((column - TRUTH[:, None]) ** 2).mean(axis=1) for column in grid.values]
    for rule in RULES:
        assert errors[grid.chosen(rule)] < 1.3 * min(errors), rule


def test_discrepancy_takes_most_without_taking_more_than_the_noise() -> None:
    empty = np.zeros((4, 1, 1))
    nan = np.full(4, np.nan)
    parameters = np.arange(4.0)
    grid = SmoothedMaps(parameters, empty, nan, np.array([0.2, 1.1, 0.9, 1.3]), nan, 1.0)
    assert grid.chosen("discrepancy") == 2
    above = SmoothedMaps(parameters, empty, nan, np.array([2.0, 1.1, 1.9, 1.3]), nan, 1.0)
    assert above.chosen("discrepancy") == 1


def test_one_repetition_cannot_be_held_out() -> None:
    grid = smooth_on_grid(shrink, measured(0, 1), SHARES, OPERATOR.mass, 1.0)
    with pytest.raises(ValueError, match="at least 2 repetitions"):
        grid.chosen("hold_out")
    with pytest.raises(ValueError, match="choose hold_out, stein"):
        grid.chosen("guess")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="empty"):
        smooth_on_grid(shrink, measured(0), [], OPERATOR.mass, 1.0)
    with pytest.raises(ValueError, match="noise is 0"):
        smooth_on_grid(shrink, measured(0), SHARES, OPERATOR.mass, 0.0)
