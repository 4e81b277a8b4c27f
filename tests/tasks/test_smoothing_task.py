"""The promised width of smoothing, and maps that hold values which are no measurements."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import surfexp as sx
from surfexp.mesh.shapes.rectangle import rectangle
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.smoothing.absurd_values import absurd_values

BALL = sx.shape("icosphere", levels=3)
HEIGHT = BALL.mesh.vertices[:, 2]
NOISY = HEIGHT + 0.1 * np.random.default_rng(0).standard_normal(len(HEIGHT))


@pytest.mark.parametrize("irregular", [0.0, 0.2])
@pytest.mark.parametrize("edges", [6.0, 10.0, 20.0])
def test_a_point_becomes_a_gaussian_of_the_promised_full_width(edges: float, irregular: float) -> None:
    mesh = rectangle(81, 81).mesh
    step = np.ptp(mesh.vertices[:, 0]) / 80
    rng = np.random.default_rng(0)
    inside = (mesh.vertices[:, :2] > 0.5 * step).all(axis=1)
    inside &= (mesh.vertices[:, :2] < mesh.vertices[:, :2].max(axis=0) - 0.5 * step).all(axis=1)
    vertices = mesh.vertices.copy()
    vertices[inside, :2] += irregular * step * rng.uniform(-1.0, 1.0, (inside.sum(), 2))
    plane = sx.Surface(TriangleMesh(vertices, mesh.faces))
    source = int(np.argmin(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1)))
    width = edges * step
    found = sx.smooth(plane, np.eye(1, len(vertices), source)[0], width).values
    distance = np.linalg.norm(vertices - vertices[source], axis=1)
    near = distance < 0.75 * width
    # log of a Gaussian is linear in the squared distance
    slope = np.polyfit(distance[near] ** 2, np.log(found[near]), 1)[0]
    assert np.sqrt(-4.0 * np.log(2.0) / slope) == pytest.approx(
        width, rel=1.0 / edges**2 + (0.005 if irregular else 0.0)
    )


@pytest.mark.parametrize("irregular", [0.0, 0.2])
@pytest.mark.parametrize("edges", [2.0, 5.0, 12.0, 40.0])
def test_the_variance_is_that_of_the_promised_width_from_two_edges_on(edges: float, irregular: float) -> None:
    """Where a kernel spans few vertices its half maximum lies between them; its variance is known all the same.

    The mean over the vertices far from the boundary: on this grid every other vertex has twice the area of its neighbours.
    """
    count = 2 * int(2.5 * edges) + 11
    plane = rectangle(count, count, count - 1.0, count - 1.0).mesh
    vertices = plane.vertices.copy()
    inner = ((vertices[:, :2] > 0.5) & (vertices[:, :2] < count - 1.5)).all(axis=1)
    vertices[inner, :2] += irregular * np.random.default_rng(1).uniform(-1.0, 1.0, (inner.sum(), 2))
    plane = TriangleMesh(vertices, plane.faces)
    far = (np.abs(vertices[:, :2] - 0.5 * (count - 1.0)) <= 3.0).all(axis=1)
    x, mass = vertices[:, 0], fem(plane).mass
    first, second = (sx.smooth(plane, values, edges).values for values in (x, x**2))
    variance = np.average((second - 2.0 * x * first + x**2)[far], weights=mass[far])
    assert np.sqrt(8.0 * np.log(2.0) * variance) == pytest.approx(edges, rel=0.01)


@pytest.mark.parametrize("edges", [2.0, 5.0, 12.0])
def test_on_a_sphere_the_mean_height_of_a_point_decays_as_the_heat_kernel_has_it(edges: float) -> None:
    ball = sx.shape("icosphere", levels=4)
    heights, mass = ball.mesh.vertices[:, 2], fem(ball.mesh).mass
    source = int(np.argmax(heights))
    width = edges * ball.mesh.edge_length
    kernel = mass * sx.smooth(ball, np.eye(1, len(heights), source)[0], width).values
    time = -0.5 * np.log(kernel @ heights / kernel.sum() / heights[source])
    assert np.sqrt(16.0 * np.log(2.0) * time) == pytest.approx(width, rel=0.01)


def test_slivers_are_smoothed_by_steps_and_say_so() -> None:
    vertices = rectangle(9, 9).mesh.vertices.copy()
    vertices[40] = vertices[41] + 1e-7 * (vertices[40] - vertices[41])
    surface = sx.Surface(TriangleMesh(vertices, rectangle(9, 9).mesh.faces))
    found = sx.smooth(surface, np.ones(81), 0.5)
    assert found.values == pytest.approx(np.ones(81), abs=1e-6) and found.certificate["steps"] == 100


@pytest.mark.parametrize("bad", [3.4028235e38, -9999.0, 1e200, -1e308])
@pytest.mark.parametrize("task", [sx.denoise, lambda *a: sx.smooth(*a, 0.3), sx.segment])
def test_a_code_for_no_data_is_found_and_named(task: object, bad: float) -> None:
    values = NOISY.copy()
    values[17] = bad
    with pytest.raises(
        ValueError, match=r"1 of 642 values far from all others, such as .* at vertex 17; .* set them to NaN"
    ):
        task(BALL, values)  # type: ignore[operator]


def test_the_way_out_of_a_code_works_and_names_the_vertices_of_the_whole() -> None:
    values = NOISY.copy()
    values[:3], values[17] = np.nan, -9999.0
    with pytest.raises(ValueError, match="at vertex 17"):
        sx.denoise(BALL, values)
    values[17] = np.nan
    assert np.isnan(sx.denoise(BALL, values).values).sum() == 4


@pytest.mark.parametrize("share", [0.002, 0.05, 0.49])
@pytest.mark.parametrize("code", [-1.0, 0.0, 9999.0, 1e30])
def test_a_code_is_found_on_up_to_half_of_a_map(code: float, share: float) -> None:
    """As on a medial wall, also where resampling has mixed it with the map at its border."""
    rng = np.random.default_rng(0)
    values = 1.0 + 1e-3 * rng.uniform(-1.0, 1.0, 1000)
    far = np.arange(1000) < 1000 * share
    values[far] = code
    np.testing.assert_array_equal(absurd_values(values), far)
    border = np.flatnonzero(far)[: int(far.sum()) // 3]
    values[border] = 1.0 + rng.uniform(0.5, 1.0, len(border)) * (code - 1.0)
    np.testing.assert_array_equal(absurd_values(values), far)


def test_a_code_is_found_beside_two_levels() -> None:
    values = (np.arange(1000) < 400) + 1e-3 * np.random.default_rng(0).standard_normal(1000)
    values[500:550] = -9999.0
    assert np.flatnonzero(absurd_values(values)).tolist() == [*range(500, 550)]


def test_several_codes_are_found_together() -> None:
    values = np.r_[NOISY, -9999.0, -9999.0, 3.4e38]
    assert np.flatnonzero(absurd_values(values)).tolist() == [642, 643, 644]


@pytest.mark.parametrize("share", [0.05, 0.1, 0.4])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_second_level_is_none_and_a_code_of_the_same_extent_is_one(share: float, sign: float) -> None:
    rng = np.random.default_rng(0)
    second = rng.uniform(size=642) < share
    levels = sign * second + 1e-3 * rng.standard_normal(642)
    assert not absurd_values(levels).any()
    assert np.array_equal(absurd_values(np.where(second, sign * 9999.0, levels)), second)
    # beside two levels a code is found, on either side of them
    for code in (-9999.0, 9999.0):
        levels[7] = code
        assert np.flatnonzero(absurd_values(levels)).tolist() == [7]


def test_a_map_of_two_clean_levels_is_segmented() -> None:
    height = BALL.vertices[:, 2]
    found = sx.segment(BALL, (height > 0.2) + 1e-3 * np.random.default_rng(0).standard_normal(len(height)))
    assert np.array_equal(found.labels == 1, height > 0.2)


@given(
    st.integers(0, 2**31),
    st.sampled_from(["normal", "t3", "ties", "constant", "lognormal", "two", "levels", "spot"]),
    st.floats(-9, 9),
)
def test_no_real_map_has_absurd_values(seed: int, kind: str, decade: float) -> None:
    rng = np.random.default_rng(seed)
    draws = {
        "normal": lambda: rng.standard_normal(500),
        "t3": lambda: rng.standard_t(3, 500),
        "ties": lambda: np.round(rng.standard_normal(500)),
        "constant": lambda: np.full(500, 3.0),
        "lognormal": lambda: rng.lognormal(size=500),
        "two": lambda: (rng.uniform(size=500) < 0.01).astype(float),
        "levels": lambda: (rng.uniform(size=500) < 0.4) + 1e-3 * rng.standard_normal(500),
        "spot": lambda: (np.arange(500) < 10) + 1e-6 * rng.standard_normal(500),
    }
    assert not absurd_values(10.0**decade * draws[kind]()).any()


def test_a_constant_map_is_refused_without_its_noise_and_returned_with_it() -> None:
    flat = np.full(len(HEIGHT), 2.0)
    with pytest.raises(ValueError, match="constant at 2: it has no noise"):
        sx.denoise(BALL, flat)
    found = sx.denoise(BALL, flat, noise=0.1, method="rof")
    assert np.array_equal(found.values, flat) and found.certificate["relative_gap"] == 0.0


def test_the_bound_of_the_error_is_a_root_mean_square_over_the_area() -> None:
    """Twice as large a ball, mapped and weighted alike, has the same root mean square error and the same bound."""
    large = sx.Surface(TriangleMesh(2.0 * BALL.mesh.vertices, BALL.mesh.faces))
    small, other = (sx.denoise(one, NOISY, noise=0.1, method="rof").certificate for one in (BALL, large))
    assert other["error_bound"] == pytest.approx(small["error_bound"], rel=1e-9)
    exact = sx.denoise(BALL, NOISY, noise=0.1, method="rof", tolerance=1e-12).values
    rough = sx.denoise(BALL, NOISY, noise=0.1, method="rof", tolerance=1e-3)
    error = np.sqrt(((rough.values - exact) ** 2).mean())
    assert error <= 1.05 * rough.certificate["error_bound"] <= 40.0 * error


@pytest.mark.parametrize("tolerance", [0.0, -1.0, 1.0, 2.0, float("nan")])
def test_a_tolerance_that_bounds_nothing_is_refused(tolerance: float) -> None:
    with pytest.raises(ValueError, match=r"tolerance = .*, a number above 1e-15 and below 1 is needed"):
        sx.denoise(BALL, NOISY, tolerance=tolerance)
