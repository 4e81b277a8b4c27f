"""The default of denoising: symmetric, in every unit, near the best of its filters, whatever the noise."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np
import pytest

import surfexp as sx
from surfexp.contract.arrays import Floats
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.fem import fem
from surfexp.smoothing import fitted_trials as fitted_trials_module
from surfexp.smoothing.fitted_smoothing import fitted_smoothing
from surfexp.smoothing.fitted_trials import Trial, fitted_trials
from surfexp.smoothing.stein_mixture import least_on_simplex, stein_mixture
from surfexp.variational.noise_reading import read_noise
from surfexp.variational.solvers.newton import newton

BALL = icosphere(3)
OPERATOR = fem(BALL.mesh)
X = BALL.mesh.vertices[:, 0]
TRUTH = 2.0 * (X > 0.1)
WHITE = np.random.default_rng(0).standard_normal(len(X))
ROUGH = TRUTH + 0.5 * WHITE


def error(values: Floats, truth: Floats = TRUTH) -> float:
    return float(np.sqrt(OPERATOR.mass @ (values - truth) ** 2 / OPERATOR.mass.sum()))


@pytest.mark.slow
def test_the_negative_map_has_the_negative_result_to_the_last_bit() -> None:
    for values in (ROUGH, np.round(ROUGH, 1)):
        one, other = fitted_smoothing(OPERATOR, values), fitted_smoothing(OPERATOR, -values)
        assert np.array_equal(other.mixture.values, -one.mixture.values) and other.mixture.risk == one.mixture.risk


def test_two_threads_give_the_same_bytes_and_progress_is_told() -> None:
    seen: list[int] = []
    one, two = (
        fitted_smoothing(OPERATOR, ROUGH, threads=threads, progress=lambda step, _: seen.append(step))
        for threads in (1, 2)
    )
    assert one.mixture.values.tobytes() == two.mixture.values.tobytes() and one.largest_gap == two.largest_gap
    assert seen and seen[: len(seen) // 2] == seen[len(seen) // 2 :]


def test_newton_takes_over_where_iterations_are_many_and_says_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both lie within their proved distances of the minimiser."""
    noise = read_noise(OPERATOR, ROUGH)
    monkeypatch.setattr(fitted_trials_module, "MANY_ITERATIONS", 0.5)
    by_both = [*fitted_trials(OPERATOR, ROUGH, noise)]
    monkeypatch.setattr(fitted_trials_module, "LARGEST_NEWTON", 0)
    by_first_order = [*fitted_trials(OPERATOR, ROUGH, noise)]
    solvers = [trial.solution.solver for trial in by_both if trial.solution is not None]
    assert {"newton", "primal_dual"} == set(solvers)
    for one, other in zip(by_both, by_first_order, strict=False):
        assert (one.method, one.parameter) == (other.method, other.parameter)
        if one.solution is not None and other.solution is not None:
            bounds = (one.solution.error_bound or 0.0) + (other.solution.error_bound or 0.0)
            apart = np.sqrt(OPERATOR.mass @ (noise.weights * (one.values - other.values) ** 2))
            assert apart <= bounds * (1.0 + 1e-9) and other.solution.solver == "primal_dual"


def test_where_newton_does_not_end_first_order_iterations_do(monkeypatch: pytest.MonkeyPatch) -> None:
    noise = read_noise(OPERATOR, ROUGH)
    monkeypatch.setattr(fitted_trials_module, "MANY_ITERATIONS", 0.5)
    monkeypatch.setattr(fitted_trials_module, "newton", partial(newton, iteration_limit=1))
    solutions = [trial.solution for trial in fitted_trials(OPERATOR, ROUGH, noise) if trial.solution is not None]
    assert all(one.converged for one in solutions) and max(one.iterations for one in solutions) > 20


@pytest.mark.parametrize(("factor", "offset"), [(1e6, 3.0), (1e-9, 0.0), (1.0, 100.0)])
def test_a_change_of_unit_changes_the_result_by_rounding(factor: float, offset: float) -> None:
    one, other = fitted_smoothing(OPERATOR, ROUGH), fitted_smoothing(OPERATOR, factor * ROUGH + offset)
    assert (other.mixture.values - offset) / factor == pytest.approx(one.mixture.values, abs=1e-6)
    assert other.mixture.risk == pytest.approx(one.mixture.risk, rel=1e-3, abs=1e-5)


@pytest.mark.slow
def test_the_risk_is_the_mean_square_error_within_its_own_error() -> None:
    shares = []
    for seed in range(12):
        rough = TRUTH + 0.5 * np.random.default_rng(seed).standard_normal(len(X))
        found = fitted_smoothing(OPERATOR, rough, 0.5).mixture
        shares.append((found.risk - (error(found.values) / 0.5) ** 2) / found.risk_error)
    assert abs(np.mean(shares)) < 1.0 and 0.4 < np.sqrt(np.mean(np.square(shares))) < 2.0


@pytest.mark.parametrize("seed", range(5))
def test_no_shares_on_a_grid_of_the_simplex_are_better_than_those_that_are_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    root, slopes = rng.standard_normal((3, 3)), rng.standard_normal(3)
    products = root @ root.T

    def energy(shares: Floats) -> float:
        return float(shares @ products @ shares + 2.0 * shares @ slopes)

    found = least_on_simplex(products, slopes)
    assert found.min() >= 0.0 and found.sum() == pytest.approx(1.0)
    steps = np.linspace(0.0, 1.0, 41)
    grid = [np.array([a, b, 1.0 - a - b]) for a, b in product(steps, steps) if a + b <= 1.0]
    assert energy(found) <= min(energy(shares) for shares in grid) + 1e-12


def test_what_is_mixed_is_no_worse_by_estimate_than_any_trial() -> None:
    noise = read_noise(OPERATOR, ROUGH)
    trials = list(fitted_trials(OPERATOR, ROUGH, noise))
    mixture = stein_mixture(OPERATOR, ROUGH, noise, trials, caution=1.0)
    alone = [stein_mixture(OPERATOR, ROUGH, noise, [trial], caution=1.0).risk for trial in trials]
    assert mixture.risk <= min(alone) + 1e-12
    assert {trial.method for trial in mixture.members} == {
        "heat_polynomial",
        "total_variation",
        "edge_weighted_variation",
    }


def test_outliers_do_not_enter_the_risk() -> None:
    noise = read_noise(OPERATOR, ROUGH)
    shifted = [Trial("total_variation", 1.0, ROUGH + 9.0 * (np.arange(len(X)) == 7), 0.0 * X, False)]
    plain = stein_mixture(OPERATOR, ROUGH, noise, shifted)
    marked = replace(noise, outliers=np.array([7]))
    assert plain.risk > stein_mixture(OPERATOR, ROUGH, marked, shifted).risk + 0.01


@pytest.mark.slow
@pytest.mark.parametrize("name", ["laplace", "t3", "outliers", "varying"])
def test_noise_that_is_not_white_costs_less_than_the_best_of_unweighted_filters_could(name: str) -> None:
    """Against the parameter of total variation and of the heat kernel that is best against the truth."""
    rng = np.random.default_rng(4)
    count = len(X)
    noise = {
        "laplace": lambda: rng.laplace(size=count) / np.sqrt(2.0),
        "t3": lambda: rng.standard_t(3, count) / np.sqrt(3.0),
        "outliers": lambda: 0.6 * rng.standard_normal(count) + 12.0 * (rng.random(count) < 0.02),
        "varying": lambda: 2.5 ** (2.0 * BALL.mesh.vertices[:, 1]) / 2.0 * rng.standard_normal(count),
    }[name]()
    rough = TRUTH + 0.5 * noise
    best = min(error(sx.denoise(BALL, rough, method="rof", weight=weight).values) for weight in 2.0 ** np.arange(-4, 2))
    best = min([best, *(error(sx.smooth(BALL, rough, width).values) for width in (0.2, 0.3, 0.4, 0.6))])
    assert error(sx.denoise(BALL, rough).values) < 1.05 * best


def test_values_with_heavy_tails_are_drawn_in_and_normal_ones_are_not() -> None:
    assert fitted_smoothing(OPERATOR, ROUGH).drawn_in == 0
    heavy = TRUTH + 0.5 * np.random.default_rng(1).laplace(size=len(X)) / np.sqrt(2.0)
    found = sx.denoise(BALL, heavy)
    assert 0.1 * len(X) < found.certificate["drawn_in"] < 0.5 * len(X)
    assert "risk" not in found.certificate and any("No estimate of the error" in note for note in found.notes)


@pytest.mark.slow
def test_the_bound_of_the_error_holds_against_tight_solves() -> None:
    """A mixture of minimisers is as near to the exact mixture as its certificate says."""
    found = sx.denoise(BALL, ROUGH, noise=0.5)
    tight = sx.denoise(BALL, ROUGH, noise=0.5, tolerance=1e-6)
    first, second = found.certificate, tight.certificate
    assert all(first[key] == second[key] for key in first if key.startswith("parameter"))
    moved = max([0.0, *(abs(first[key] - second[key]) for key in first if key.startswith("share_"))])
    assert error(found.values, tight.values) <= found.certificate["error_bound"] + moved * np.ptp(ROUGH)
    assert tight.certificate["error_bound"] < 0.1 * found.certificate["error_bound"]
