"""The grid of level sets on patches, planted maps and where groups differ on it."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.shapes.strip import strip
from surfexp.skeleton.level_contours import level_contours
from surfexp.skeleton.parametrization import level_set_parametrization
from surfexp_studies.skeletons.callosum import callosum
from surfexp_studies.skeletons.callosum_shape import callosum_shape
from surfexp_studies.skeletons.patch_grid import GridComparison, compare_on_grid, map_on, patch_grid, region_found
from surfexp_studies.skeletons.planted_map import PLACE, midline_coordinates, planted_map
from surfexp_studies.skeletons.positionwise_comparison import PointwiseTest

FLAT = rectangle(121, 25, 5.0, 1.0).mesh


def test_parametrisation_of_a_rectangle_is_the_rectangle():
    levels = np.linspace(0.2, 4.8, 12)
    grid = level_set_parametrization(FLAT, FLAT.vertices[:, 0], levels, 9, {"y": FLAT.vertices[:, 1]})
    assert np.allclose(grid.width, 1.0) and np.allclose(grid.u, np.linspace(0, 1, 12))
    assert np.allclose(grid.points[:, :, 0], levels[:, None])
    assert np.allclose(grid.points[:, :, 1], 1.0 - grid.v) and np.allclose(grid.maps["y"], grid.points[:, :, 1])
    backward = level_set_parametrization(FLAT, -FLAT.vertices[:, 0], -levels[::-1], 9)
    assert np.allclose(backward.points[:, :, 1], backward.v)
    with pytest.raises(ValueError, match="single open one"):
        level_set_parametrization(FLAT, np.sin(3 * FLAT.vertices[:, 0]), np.array([0.5]))
    with pytest.raises(ValueError, match="at least 2"):
        level_set_parametrization(FLAT, FLAT.vertices[:, 0], levels, 1)


def test_small_contours_around_teeth_are_left_out_and_counted():
    x, y, _ = FLAT.vertices.T
    values = x + 1.2 * np.maximum(0.0, 0.12 - np.hypot(x - 2.0, y - 1.0)) / 0.12
    levels = np.array([1.0, 2.7, 4.0])
    assert len(level_contours(FLAT, values, levels).level) == 4
    with pytest.raises(ValueError, match="has 2 contours, open"):
        level_set_parametrization(FLAT, values, levels)
    with pytest.raises(ValueError, match="has 2 contours, open"):
        level_set_parametrization(FLAT, values, levels, 5, persistence=0.1)
    grid = level_set_parametrization(FLAT, values, levels, 5, persistence=0.3)
    assert grid.left_out == 1 and np.allclose(grid.points[:, :, 0], levels[:, None])


def test_the_grid_of_a_bent_strip_keeps_its_flat_coordinates():
    surface = strip(jag=0.0, bend=1.0)
    grid = patch_grid(surface, along=30, across=7)
    maps = {"x": surface.coordinates[:, 0], "y": surface.coordinates[:, 1]}
    again = patch_grid(type(surface)(surface.mesh, scalars=maps), along=30, across=7, chosen="y", ahead=(1.0, 0.0, 0.0))
    assert np.allclose(grid.points, again.points)
    assert np.abs(again.maps["y"] - 12.0 * (0.5 - again.v)).max() < 0.1
    assert np.allclose(map_on(grid, "width"), 12.0, atol=0.1)
    along = patch_grid(type(surface)(surface.mesh, scalars=maps), along=30, across=7, chosen="x").maps["x"]
    assert np.abs(along - 60.0 * (np.arange(30) + 0.5)[:, None] / 30).max() < 0.3
    with pytest.raises(ValueError, match="choose one of width, boundary_distance"):
        patch_grid(surface, chosen="thickness")


def test_midline_coordinates_of_points_put_beside_the_midline():
    shape = callosum_shape(4)
    ahead = np.gradient(shape.midline, axis=0)
    left = np.stack([-ahead[:, 1], ahead[:, 0]], axis=1) / np.linalg.norm(ahead, axis=1, keepdims=True)
    inner = np.arange(20, 780, 20)
    for across in (0.2, 0.5, 0.8):
        points = shape.midline + (1.0 - 2.0 * across) * shape.half_width[:, None] * left
        along, found = midline_coordinates(points[inner], shape)
        assert np.abs(along - inner / 800).max() < 0.02 and np.abs(found - across).max() < 0.02
    bump = planted_map(shape.midline, shape, 50.0, 1) - planted_map(shape.midline, shape, 0.0, 1)
    expected = 50.0 * np.exp(-0.5 * ((0.5 - PLACE[1]) / 0.15) ** 2)
    assert bump.max() == pytest.approx(expected, rel=0.02) and abs(bump.argmax() / 800 - PLACE[0]) < 0.01
    noise = np.concatenate([planted_map(shape.midline, shape, 0.0, seed) for seed in range(40)])
    assert noise.std() == pytest.approx(1.0, abs=0.1) and abs(noise.mean()) < 0.15


@pytest.mark.slow
def test_a_planted_bump_is_found_where_it_is_and_nowhere_else():
    with_bump = {str(i): callosum(100 + i, edge_length=1.0, signal=4.0) for i in range(8)}
    without = {str(i): callosum(i, edge_length=1.0, signal=0.0) for i in range(8)}
    found = compare_on_grid(with_bump, without, along=24, across=9, chosen="signal", permutations=300)
    region = region_found(found)
    assert region["smallest_corrected_p"] <= 0.02 and 2 <= region["points_found"] < 0.15 * region["points"]
    # tips lie beyond the midline's ends: 0.60 of it is 0.61 of the skeleton
    assert abs(region["centre_u"] - 0.61) < 0.08 and abs(region["centre_v"] - PLACE[1]) < 0.15
    assert (found.test.statistic[found.test.corrected <= 0.05] > 0).all()


def test_the_region_found_is_told_in_u_and_v():
    u, v = np.linspace(0, 1, 5), np.linspace(0, 1, 3)
    statistic, corrected = np.zeros((5, 3)), np.ones((5, 3))
    statistic[3, 1:] = -5.0
    # a p equal to the level is one that is found
    corrected[3, 1:] = 0.05
    uncorrected = corrected.copy()
    uncorrected[0, 0] = 0.05
    empty = np.zeros((0, 5, 3))
    test = PointwiseTest(statistic.ravel(), uncorrected.ravel(), corrected.ravel())
    region = region_found(GridComparison(u, v, empty, empty, test, 0))
    assert (region["points"], region["points_uncorrected"], region["smallest_corrected_p"]) == (15.0, 3.0, 0.05)
    assert (region["points_found"], region["centre_u"], region["centre_v"]) == (2.0, 0.75, 0.75)
    assert (region["from_v"], region["to_v"], region["from_u"]) == (0.5, 1.0, 0.75)
    nothing = PointwiseTest(statistic.ravel(), np.ones(15), np.ones(15))
    assert region_found(GridComparison(u, v, empty, empty, nothing, 0))["points_found"] == 0
