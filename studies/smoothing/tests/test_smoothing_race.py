"""The smoothing race measures what it says: planted borders, leaks, noise and methods whose answers are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.calculus import gradient
from surfexp.operators.fem import fem
from surfexp.smoothing.edge_weights import edge_weighted
from surfexp.smoothing.geodesic_gaussian import WIDTH_OF_DEVIATION
from surfexp.smoothing.methods import COARSE_WEIGHTS, WEIGHTS, MethodName, Methods, heat_time
from surfexp.tasks.spectra import eigenpairs
from surfexp.variational.image import Image
from surfexp_studies.smoothing.border_measures import border_measures, false_border_of_noise, profile_width
from surfexp_studies.smoothing.carried_over_mask import carried_over_mask, iterations_as_wide
from surfexp_studies.smoothing.chosen_smoothing import chosen_smoothing
from surfexp_studies.smoothing.planted_maps import planted_parcels, repeated_map

# a sheet of 120 by 60 mm with edges of 1 mm
SHEET = rectangle(121, 61, 120.0, 60.0)
FLAT = fem(SHEET.mesh)
X, Y = SHEET.mesh.vertices[:, 0], SHEET.mesh.vertices[:, 1]
MIDDLE = 0.5 * (X.min() + X.max())
UPPER = MIDDLE + 0.25 < X
LEVELS = (0.0, 2.0)
BALL = Surface(TriangleMesh(30.0 * icosphere(4).mesh.vertices, icosphere(4).mesh.faces), "ball", "mm")


@pytest.mark.parametrize("shift", [0.0, 3.0, -5.0])
def test_a_border_that_is_moved_is_as_far_away(shift: float) -> None:
    moved = 2.0 * (MIDDLE + 0.25 + shift < X)
    measures = border_measures(SHEET.mesh, FLAT, moved, UPPER, LEVELS)
    assert measures["border_distance"] == pytest.approx(abs(shift), abs=0.5 * FLAT.edge_length)
    assert measures["false_border"] == 0.0


@pytest.mark.parametrize("ramp", [5.0, 10.0, 20.0])
def test_the_width_of_a_ramp_is_four_fifths_of_it(ramp: float) -> None:
    values = 2.0 * np.clip((X - MIDDLE) / ramp + 0.5, 0.0, 1.0)
    measures = border_measures(SHEET.mesh, FLAT, values, UPPER, LEVELS)
    assert measures["border_width"] == pytest.approx(0.8 * ramp, abs=FLAT.edge_length)
    assert measures["border_distance"] < FLAT.edge_length


def test_the_width_is_that_of_a_narrow_strip_too() -> None:
    strip = rectangle(121, 3, 120.0, 0.5)
    operator, x = fem(strip.mesh), strip.mesh.vertices[:, 0]
    middle = 0.5 * (x.min() + x.max())
    values = 2.0 * np.clip((x - middle) / 10.0 + 0.5, 0.0, 1.0)
    assert profile_width(operator, values, x - middle, LEVELS) == pytest.approx(8.0, abs=operator.edge_length)


def test_an_island_far_from_the_border_is_false_by_its_length() -> None:
    radius, centre = 8.0, (MIDDLE - 40.0, 0.5 * (Y.min() + Y.max()))
    distance = np.hypot(X - centre[0], Y - centre[1])
    values = 2.0 * UPPER + np.clip(radius + 0.5 - distance, 0.0, 1.0) * 2.0
    measures = border_measures(SHEET.mesh, FLAT, values, UPPER, LEVELS)
    assert measures["false_border"] == pytest.approx(100.0 * 2.0 * np.pi * radius / (120.0 * 60.0), rel=0.03)


def test_nothing_found_has_no_distance_and_the_widest_profile() -> None:
    measures = border_measures(SHEET.mesh, FLAT, np.full(len(X), 0.1), UPPER, LEVELS)
    assert "border_distance" not in measures and measures["false_border"] == 0.0
    assert profile_width(FLAT, np.full(len(X), 0.3), X - MIDDLE, LEVELS) > 28.0
    with pytest.raises(ValueError, match=r"at 7381 of 7381 vertices: there is no border"):
        border_measures(SHEET.mesh, FLAT, X, np.ones(len(X), dtype=bool), LEVELS)


def test_false_borders_of_noise_count_both_signs() -> None:
    wave = np.sin(2.0 * np.pi * (X - X.min()) / 40.0)
    # three periods cross a half and minus a half twelve times in all, over 60 mm each
    assert false_border_of_noise(SHEET.mesh, FLAT, wave, 0.5) == pytest.approx(100.0 * 12 * 60.0 / 7200.0, rel=0.01)
    assert false_border_of_noise(SHEET.mesh, FLAT, np.zeros(len(X)), 0.5) == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("name", ["heat_flow", "geodesic_gaussian", "neighbour_mean"])
def test_what_is_carried_over_a_straight_border_is_that_of_a_gaussian(name: str) -> None:
    width, inside = 8.0, ~UPPER
    found = carried_over_mask(SHEET.mesh, inside, name, width).metrics  # type: ignore[arg-type]
    deviation = width / WIDTH_OF_DEVIATION
    # a half-line of 1 leaves deviation / sqrt(2 pi) beyond its end; the border runs half an edge outside
    share = 100.0 * deviation / np.sqrt(2.0 * np.pi) / (MIDDLE + 0.5 - X.min())
    assert found["carried"] == pytest.approx(share, rel=0.12)
    # (1 - Phi)^2 over 10 mm beside the border
    steps = np.linspace(0.5, 10.0, 400) / deviation
    tail = 0.5 * (1.0 - np.vectorize(__import__("math").erf)(steps / np.sqrt(2.0)))
    assert found["error_near_mask"] == pytest.approx(100.0 * np.sqrt(np.mean(tail**2)), rel=0.2)
    assert found["error_near_mask_masked"] < 1e-8


def test_masks_without_two_sides_are_refused() -> None:
    with pytest.raises(ValueError, match="nothing can be carried"):
        carried_over_mask(SHEET.mesh, np.ones(len(X), dtype=bool), "heat_flow", 4.0)
    with pytest.raises(ValueError, match="choose neighbour_mean"):
        carried_over_mask(SHEET.mesh, UPPER, "median", 4.0)  # type: ignore[arg-type]


def test_iterations_grow_with_the_square_of_the_width() -> None:
    # five-point neighbours and two diagonals: degree 6, mean square (4 * 1 + 2 * 2) / 6, variance 8 / 7 of both directions
    deviation = 20.0 / WIDTH_OF_DEVIATION
    assert iterations_as_wide(SHEET.mesh, 20.0) == pytest.approx(2.0 * deviation**2 / (8.0 / 7.0), rel=0.03)
    assert iterations_as_wide(SHEET.mesh, 0.1) == 1


def test_parcels_have_two_levels_and_noise_of_deviation_one() -> None:
    image = planted_parcels(BALL, parcels=8, contrast=3.0, seed=4)
    assert image.clean is not None
    assert set(np.unique(image.clean)) == {0.0, 3.0} and (image.clean[:, 0] == image.clean[:, 1]).all()
    assert (image.labels["parcels"] == (image.clean[:, 0] > 0)).all()
    noise = image.values - image.clean
    assert noise.std(axis=0) == pytest.approx(1.0, abs=0.05)
    assert abs(np.corrcoef(noise.T)[0, 1]) < 0.06
    shares = [planted_parcels(BALL, parcels=30, contrast=3.0, seed=seed).labels["parcels"].mean() for seed in range(6)]
    assert np.mean(shares) == pytest.approx(0.5, abs=0.08)
    again = planted_parcels(BALL, parcels=8, contrast=3.0, seed=4)
    assert (again.values == image.values).all()
    assert not planted_parcels(BALL, contrast=0.0).labels


def test_smooth_noise_has_the_width_that_was_asked_for() -> None:
    width = 15.0
    image = planted_parcels(BALL, contrast=0.0, correlation=width, seed=1)
    mass = fem(BALL.mesh).mass
    assert mass @ image.values**2 / mass.sum() == pytest.approx(1.0)
    # noise under a kernel of deviation s is correlated as a Gaussian of deviation sqrt(2) s
    deviation = np.sqrt(2.0) * width / WIDTH_OF_DEVIATION
    directions = BALL.mesh.vertices / np.linalg.norm(BALL.mesh.vertices, axis=1)[:, None]
    angles = 30.0 * np.arccos(np.clip(directions[::7] @ directions.T, -1.0, 1.0))
    seeds = [planted_parcels(BALL, contrast=0.0, correlation=width, seed=seed).values for seed in range(8)]
    values = np.column_stack(seeds)
    products = (values[::7] @ values.T) / values.shape[1]
    for distance in (deviation, 2.0 * deviation):
        near = np.abs(angles - distance) < 1.0
        assert products[near].mean() == pytest.approx(np.exp(-((distance / deviation) ** 2) / 2.0), abs=0.12)


def test_a_repeated_map_is_in_its_own_deviations() -> None:
    surface = replace(
        BALL, scalars={"height": 5.0 + BALL.mesh.vertices[:, 2], "flat": np.ones(len(BALL.mesh.vertices))}
    )
    image = repeated_map(surface, "height", noise=0.5, seed=3)
    assert image.clean is not None
    mass = fem(BALL.mesh).mass
    assert mass @ image.clean[:, 0] == pytest.approx(0.0, abs=1e-9)
    assert mass @ image.clean[:, 0] ** 2 / mass.sum() == pytest.approx(1.0)
    assert (image.values - image.clean).std() == pytest.approx(0.5, abs=0.02)
    for name, message in (("depth", "which has height, flat"), ("flat", "is constant")):
        with pytest.raises(ValueError, match=message):
            repeated_map(surface, name)
    with pytest.raises(ValueError, match="must be positive"):
        repeated_map(surface, "height", noise=0.0)
    with pytest.raises(ValueError, match=r"must be in 2\.\.2562"):
        planted_parcels(BALL, parcels=1)
    with pytest.raises(ValueError, match="0 or more"):
        planted_parcels(BALL, contrast=-1.0)


LINEAR: tuple[MethodName, ...] = ("none", "neighbour_mean", "geodesic_gaussian", "heat_flow", "heat_polynomial")
CONVEX: tuple[MethodName, ...] = ("total_variation", "edge_weighted_variation", "generalised_variation")


@pytest.mark.slow
@pytest.mark.parametrize("name", [*LINEAR, *CONVEX])
def test_methods_follow_the_scale_of_the_map_and_keep_constants(name: MethodName) -> None:
    mesh, operator = BALL.mesh, fem(BALL.mesh)
    maps = np.random.default_rng(0).standard_normal((len(mesh.vertices), 1)) + mesh.vertices[:, :1] / 10.0
    tight = {"tolerance": 1e-8, "generalised_tolerance": 1e-4}
    smoother, grid = Methods(mesh, operator, 1.0, **tight).smoother(name)
    thrice, _ = Methods(mesh, operator, 3.0, **tight).smoother(name)
    parameter = grid[len(grid) // 2]
    smoothed = smoother(maps, parameter)
    assert thrice(3.0 * maps + 7.0, parameter) == pytest.approx(
        3.0 * smoothed + 7.0, abs=5e-2 if name in CONVEX else 1e-6
    )
    if name not in ("neighbour_mean", "none"):
        tolerance = 1e-2 if name == "geodesic_gaussian" else 1e-6
        assert operator.mass @ smoothed[:, 0] == pytest.approx(
            operator.mass @ maps[:, 0], abs=tolerance * operator.mass.sum()
        )
    if name != "none":
        assert smoothed.std() < maps.std()


def test_grids_run_from_weak_to_strong() -> None:
    mesh, operator = BALL.mesh, fem(BALL.mesh)
    maps = np.random.default_rng(0).standard_normal((len(mesh.vertices), 1))
    methods = Methods(mesh, operator, 1.0)
    for name in ("heat_flow", "geodesic_gaussian", "neighbour_mean"):
        smoother, grid = methods.smoother(name)
        spreads = [smoother(maps, parameter).std() for parameter in grid]
        assert spreads == sorted(spreads, reverse=True) and grid == tuple(sorted(grid))
    smoother, grid = methods.smoother("total_variation")
    assert smoother(maps, grid[0]).std() < smoother(maps, grid[-1]).std()
    assert methods.all_converged and 0.0 < methods.largest_gap <= 1e-3
    assert grid == WEIGHTS and methods.smoother("generalised_variation")[1] == COARSE_WEIGHTS
    assert WEIGHTS[0] == 0.125 and WEIGHTS[-1] == 4.0 and COARSE_WEIGHTS == (0.25, 0.5, 1.0, 2.0)
    with pytest.raises(ValueError, match="needs an eigensystem"):
        methods.smoother("truncated_modes")[0](maps, 10.0)


def test_truncated_modes_are_a_projection() -> None:
    mesh, operator = BALL.mesh, fem(BALL.mesh)
    modes = eigenpairs(BALL, 60)
    smoother, grid = Methods(mesh, operator, 1.0, modes).smoother("truncated_modes")
    assert grid == (10.0, 20.0, 50.0)
    maps = np.random.default_rng(0).standard_normal((len(mesh.vertices), 2))
    once = smoother(maps, 20.0)
    assert smoother(once, 20.0) == pytest.approx(once, abs=1e-8)
    assert smoother(modes.vectors[:, 5:25:19], 20.0) == pytest.approx(modes.vectors[:, 5:25:19] * [1.0, 0.0], abs=1e-8)


def test_the_width_of_heat_flow_is_full_at_half_maximum() -> None:
    # exp(-x^2 / (4 t)) is a half at half the width
    assert np.exp(-(3.0**2) / (4.0 * heat_time(6.0))) == pytest.approx(0.5)


def test_weights_are_small_where_the_guide_is_steep() -> None:
    values = np.tanh((X - MIDDLE) / 3.0)
    weighted = edge_weighted(FLAT, values, 1e-6)
    slopes, reduced = (np.linalg.norm(gradient(each, values), axis=1) for each in (FLAT, weighted))
    mean = FLAT.areas @ slopes / FLAT.areas.sum()
    assert reduced == pytest.approx(slopes / (1.0 + (slopes / mean) ** 2), rel=1e-3, abs=1e-12)
    with pytest.raises(ValueError, match="is constant"):
        edge_weighted(FLAT, np.ones(len(X)), 1.0)


def test_what_is_chosen_is_measured_against_the_truth() -> None:
    image = planted_parcels(BALL, parcels=6, contrast=3.0, seed=2)
    operator = fem(BALL.mesh)
    found = chosen_smoothing(BALL.mesh, operator, image, "heat_flow")
    assert image.clean is not None
    errors = (found.values - image.clean) ** 2
    by_hand = np.sqrt(operator.mass @ errors.mean(axis=1) / operator.mass.sum())
    assert found.metrics["rmse"] == pytest.approx(by_hand)
    assert found.metrics["rmse oracle"] <= min(
        found.metrics[f"rmse {rule}"] for rule in ("hold_out", "stein", "discrepancy")
    )
    assert found.metrics["rmse"] == found.metrics["rmse hold_out"] < 1.0
    assert 0.9 < found.metrics["noise_estimate"] < 1.1 and found.metrics["at_the_end"] == 0.0
    share = operator.mass / operator.mass.sum()
    correlations = []
    for smoothed, clean in zip(found.values.T, image.clean.T, strict=True):
        covariance = np.cov(np.stack([smoothed, clean]), aweights=share)
        correlations.append(covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]))
    assert found.metrics["correlation"] == pytest.approx(np.mean(correlations))
    assert {"border_distance", "border_width", "false_border"} <= found.metrics.keys()
    other = chosen_smoothing(BALL.mesh, operator, image, "heat_flow", rule="discrepancy")
    assert other.metrics["rmse"] == found.metrics["rmse discrepancy"]


def test_a_single_map_is_chosen_by_steins_estimate() -> None:
    values = BALL.mesh.vertices[:, 2] / 10.0
    rough = values + np.random.default_rng(0).standard_normal(len(values))
    operator = fem(BALL.mesh)
    found = chosen_smoothing(BALL.mesh, operator, Image(rough, clean=values), "heat_flow")
    assert found.values.shape == rough.shape and "rmse hold_out" not in found.metrics
    assert found.metrics["rmse"] == found.metrics["rmse stein"] < 0.5
    none = chosen_smoothing(BALL.mesh, operator, Image(rough, clean=values), "none")
    assert none.metrics["at_the_end"] == 0.0 and (none.values == rough).all()
