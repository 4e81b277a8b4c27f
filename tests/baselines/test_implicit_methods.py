"""The level-set and the closest-point method against exact and intrinsic solutions, and their iterations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from excess_over_data import excess_over_data

from surfexp.baselines.closest_point import closest_point
from surfexp.baselines.grid_interpolation import GridInterpolation
from surfexp.baselines.level_set import LevelSet, level_set
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.separable_quadratic import convex_chan_vese, rof
from surfexp.variational.solvers.primal_dual import primal_dual

MESH = icosphere(4).mesh
OPERATOR = fem(MESH)
ANGLE = 0.9
CAP = MESH.vertices[:, 2] > np.cos(ANGLE)
NOISY = CAP + np.random.default_rng(0).normal(0, 0.3, len(CAP))
FIDELITY = convex_chan_vese(OPERATOR.mass, ((1 - NOISY) ** 2 - NOISY**2) / (3 * MESH.edge_length))


class Idle(GridInterpolation):
    """Leaves the values as they are, in place of the extension."""

    def __call__(self, values):
        return values


def exact_cap(mu):
    """ROF of the indicator of a cap: 1 - L / (mu A1) inside, L / (mu A2) outside."""
    length, area = 2 * np.pi * np.sin(ANGLE), 2 * np.pi * (1 - np.cos(ANGLE))
    return np.where(CAP, 1 - length / (mu * area), length / (mu * (4 * np.pi - area)))


def rof_error(method):
    """Mean distance of ROF of the cap, smeared over two edges, from the exact solution for the sharp one."""
    clean = np.clip((ANGLE - np.arccos(np.clip(MESH.vertices[:, 2], -1, 1))) / (2 * MESH.edge_length) + 0.5, 0, 1)
    solution = method(rof(OPERATOR.mass, clean, 8.0), OPERATOR)
    assert solution.converged, solution.reason
    return OPERATOR.mass @ np.abs(solution.values - exact_cap(8.0)) / OPERATOR.mass.sum()


@pytest.mark.slow
def test_rof_by_closest_points_approaches_the_exact_solution():
    errors = [rof_error(replace(closest_point(MESH, step), tolerance=1e-3)) for step in (0.2, 0.1, 0.05)]
    assert errors[2] < 0.8 * errors[1] < 0.64 * errors[0], errors
    assert errors[2] < 0.02, errors


def test_rof_by_level_set_approaches_the_exact_solution():
    """Its error is that of the regularisation more than that of the grid."""
    errors = [rof_error(replace(level_set(MESH, 0.2), regularisation=eps)) for eps in (0.1, 0.03, 0.01)]
    assert errors[2] < 0.85 * errors[1] < 0.85 * 0.85 * errors[0], errors
    assert errors[2] < 0.05, errors


@pytest.mark.parametrize(("prepare", "bound"), [(closest_point, 0.006), (level_set, 0.015)])
def test_segmentation_of_a_cap_approaches_the_intrinsic_one(prepare, bound):
    reference = primal_dual(FIDELITY, OPERATOR, tolerance=1e-5)
    assert reference.lower_bound is not None
    differences, excesses = [], []
    for step in (0.2, 0.1, 0.05):
        solution = prepare(MESH, step)(FIDELITY, OPERATOR)
        assert solution.converged and solution.lower_bound is None
        differences.append(OPERATOR.mass @ np.abs(solution.values - reference.values) / OPERATOR.mass.sum())
        excesses.append(excess_over_data(FIDELITY, OPERATOR, solution.values, reference.lower_bound))
    assert differences[2] < 0.9 * differences[1] < 0.6 * differences[0], differences
    assert 0 < excesses[2] < excesses[1] < excesses[0] < 0.05, excesses
    assert excesses[2] < bound, excesses
    assert OPERATOR.mass @ ((solution.values > 0.5) == CAP) / OPERATOR.mass.sum() > 0.99


def test_explicit_steps_lower_the_energy_up_to_the_bound_and_not_far_beyond():
    """Without re-extension the descent is monotone; a step five times the bound is not."""
    method = replace(level_set(MESH, 0.15), tolerance=-1.0, step_limit=1000)
    method = replace(method, to_closest=Idle(method.to_closest.starts, method.to_closest.fractions))
    energies = method(FIDELITY, OPERATOR).history["energy"]
    assert (np.diff(energies) <= 1e-12 * abs(energies[0])).all()

    class Reckless(type(method.energy)):
        difference_bound = method.energy.difference_bound / 5

    reckless = replace(method, energy=Reckless(method.energy.band))
    assert reckless(FIDELITY, OPERATOR).history["energy"][-1] > energies[-1] + 1e-3


def test_the_band_gap_proves_the_band_energy():
    method = closest_point(MESH, 0.15)
    loose = replace(method, tolerance=1e-2)(FIDELITY, OPERATOR)
    tight = replace(method, tolerance=1e-6)(FIDELITY, OPERATOR)
    energy, share = loose.metrics["band_energy"], loose.metrics["band_gap"]
    trivial = method.energy.fidelity(FIDELITY).trivial_energy
    # the share is (energy - bound) / (trivial - bound)
    bound = (energy - share * trivial) / (1.0 - share)
    fall = energy - tight.metrics["band_energy"]
    assert -1e-6 * (trivial - bound) <= fall <= energy - bound
    assert tight.metrics["band_gap"] <= 1e-6 < loose.metrics["band_gap"] <= 1e-2


def test_steps_that_follow_the_strong_convexity_close_the_gap_as_the_square() -> None:
    """A hundredth of the gap asks for at most some ten times the iterations."""
    model = rof(OPERATOR.mass, NOISY, 20.0)
    solved = [replace(closest_point(MESH, 0.15), tolerance=gap)(model, OPERATOR) for gap in (1e-2, 1e-4)]
    assert all(one.converged for one in solved) and solved[1].iterations <= 15 * solved[0].iterations


def test_a_limit_reached_is_told():
    for method in (replace(closest_point(MESH, 0.2), iteration_limit=3), replace(level_set(MESH, 0.2), step_limit=10)):
        solution = method(FIDELITY, OPERATOR)
        assert not solution.converged and "limit" in solution.reason


def test_a_model_runs_on_them_and_they_start_from_a_solution():
    image = Image(NOISY, labels={"cap": CAP})
    intrinsic = ConvexChanVese(smoothness=0.6).run(image, OPERATOR, primal_dual)
    for method in (closest_point(MESH, 0.1), level_set(MESH, 0.1)):
        solution = ConvexChanVese(smoothness=0.6).run(image, OPERATOR, method)
        assert solution.metrics["c1"] == pytest.approx(intrinsic.metrics["c1"], abs=0.02)
        assert solution.metrics["dice cap"] > intrinsic.metrics["dice cap"] - 0.02
        assert solution.metrics["memory_bytes"] > 100 * solution.metrics["node_count"]


@pytest.mark.parametrize("prepare", [closest_point, level_set])
def test_the_energy_of_a_start_within_the_bounds_is_finite_though_interpolation_rounds(prepare):
    start = primal_dual(FIDELITY, OPERATOR, tolerance=1e-3)
    method = prepare(MESH, 0.1)
    assert start.values.min() >= 0.0 and start.values.max() == 1.0
    limit = {"iteration_limit": 3} if prepare is closest_point else {"step_limit": 3}
    assert np.isfinite(replace(method, **limit)(FIDELITY, OPERATOR, start).history["energy"]).all()


def test_the_level_set_method_tells_its_steps_and_how_the_energy_falls():
    told = []
    method = replace(level_set(MESH, 0.3), regularisation=0.1, progress=lambda *row: told.append(row), step_limit=9)
    solution = method(FIDELITY, OPERATOR)
    steps, falls = zip(*told, strict=True)
    assert list(steps) == solution.history["iteration"].tolist() and steps[-1] == 9
    assert falls[0] == np.inf and np.isfinite(falls[1:]).all()


def test_results_are_the_same_to_the_byte():
    first, second = (level_set(MESH, 0.2)(FIDELITY, OPERATOR).values for _ in range(2))
    assert first.tobytes() == second.tobytes()
    assert isinstance(level_set(MESH, 0.2), LevelSet)
