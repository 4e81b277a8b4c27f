"""Two maps compared: the correlation, its level and interval, the choice of the null model, what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binom

import surfexp as sx
from surfexp.nulls.fields import gaussian_fields
from surfexp.nulls.rejection import correlations, p_values
from surfexp.operators.fem import fem

BALL = sx.shape("icosphere", levels=3)
X, Y, Z = BALL.mesh.vertices.T
AREAS = BALL.mesh.vertex_areas


def weighted_correlation(a: np.ndarray, b: np.ndarray, weights: np.ndarray) -> float:
    table = np.cov(a, b, aweights=weights)
    return float(table[0, 1] / np.sqrt(table[0, 0] * table[1, 1]))


def test_the_correlation_is_weighted_by_area_and_told_from_chance_by_the_surrogates() -> None:
    body = sx.Surface((BALL.mesh.vertices * [1.0, 1.0, 3.0], BALL.mesh.faces))
    areas = body.mesh.vertex_areas
    other = Z + np.random.default_rng(0).standard_normal(len(Z))
    found = sx.compare_maps(body, Z * X, other, count=199, modes=36)
    assert found.r == pytest.approx(weighted_correlation(Z * X, other, areas))
    assert found.r != pytest.approx(np.corrcoef(Z * X, other)[0, 1], abs=1e-3)
    for k in (0, 50, 198):
        assert found.null[k] == pytest.approx(weighted_correlation(found.surrogates.values[:, k], other, areas))
    assert found.p == (1 + (np.abs(found.null) >= abs(found.r)).sum()) / 200
    assert found.interval[0] < found.r < found.interval[1]
    assert found.observations == pytest.approx(1.0 + 1.0 / np.mean(found.null**2))


def test_a_map_is_itself() -> None:
    rough = gaussian_fields(fem(BALL.mesh), 0.3, 1, seed=0)[:, 0]
    found = sx.compare_maps(BALL, rough, 3.0 * rough + 1.0, count=99)
    assert found.r == pytest.approx(1.0) and found.p == 0.01
    assert sx.compare_maps(BALL, rough, -rough, count=99).p == 0.01


@pytest.mark.parametrize(
    ("width", "modes", "method"),
    [(2.0, 16, "eigenstrapping"), (0.4, 16, "variogram"), (0.4, 200, "eigenstrapping"), (0.02, 16, "eigenstrapping")],
)
def test_the_model_is_chosen_by_what_the_modes_hold(width: float, modes: int, method: str) -> None:
    values = gaussian_fields(fem(BALL.mesh), width, 1, seed=1)[:, 0]
    found = sx.compare_maps(BALL, values, Z, count=19, modes=modes)
    assert found.method == method and f"{modes} modes hold" in found.reason
    assert found.reason.startswith({"eigenstrapping": "Eigenstrapping: ", "variogram": "Variograms: "}[method])
    asked = sx.compare_maps(BALL, values, Z, count=19, modes=modes, method="eigenstrapping")
    assert asked.method == "eigenstrapping" and "was asked for" in asked.reason
    assert any("too rough" in note for note in asked.notes) == (method == "variogram")
    assert sx.compare_maps(BALL, values, Z, count=19, method="variogram").method == "variogram"


def test_what_is_unknown_in_either_map_is_outside() -> None:
    first, second = np.where(Z > -0.6, Z * X, np.nan), np.where(Z < 0.9, Y + 0.3 * Z * X, np.nan)
    found = sx.compare_maps(BALL, first, second, count=49, modes=36)
    inside = np.isfinite(found.surrogates.values).all(axis=1)
    assert not inside[np.isnan(first) | np.isnan(second)].any()
    assert any("these are the mask" in note for note in found.notes)
    masked = sx.compare_maps(replace(BALL, mask=(Z > -0.6) & (Z < 0.9)), Z * X, Y + 0.3 * Z * X, count=49, modes=36)
    assert masked.r == pytest.approx(found.r) and masked.p == found.p
    cut = sx.compare_maps(replace(BALL, mask=Z > -0.6), Z * X, second, count=49, modes=36)
    assert cut.r == masked.r and cut.p == masked.p
    assert any("vertices inside the mask: they are outside." in note for note in cut.notes)


def test_it_is_repeatable_and_maps_have_names() -> None:
    named = replace(BALL, scalars={"a": Z * X, "b": Y})
    one, two = (sx.compare_maps(named, "a", "b", count=49, modes=36, seed=s) for s in (3, 3))
    assert (one.null == two.null).all()
    assert (one.null != sx.compare_maps(named, "a", "b", count=49, modes=36).null).any()
    assert "95 % interval" in repr(one) and one.facts["null maps"] == 49


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"first": np.ones(642)}, "the map is constant at 1"),
        ({"second": np.ones(642)}, "the second map is constant at 1"),
        ({"second": Z[:5]}, "the surface has 642 vertices"),
        ({"method": "spin"}, "choose one of auto, eigenstrapping, variogram"),
        ({"count": 0}, "count = 0"),
    ],
)
def test_mistakes_are_told(given: dict, line: str) -> None:
    with pytest.raises(ValueError, match=line):
        sx.compare_maps(BALL, **{"first": Z, "second": X} | given)


@pytest.mark.slow
def test_the_level_and_the_interval_hold_for_smooth_fields() -> None:
    """300 pairs of independent fields, and as many that correlate by .5: rejections and covers in their binomial 99.9 %."""
    fields = gaussian_fields(fem(BALL.mesh), 0.5, 600, seed=2)
    rejected = covered = related = 0
    for first, second in zip(fields[:, :300].T, fields[:, 300:].T, strict=True):
        found = sx.compare_maps(BALL, first, second, count=99, modes=100)
        rejected += found.p <= 0.05
        covered += found.interval[0] <= 0.0 <= found.interval[1]
        mixed = 0.5 * first + np.sqrt(0.75) * second
        null = correlations(found.surrogates.values, mixed[:, None], AREAS)
        related += p_values(np.array([weighted_correlation(first, mixed, AREAS)]), null)[0] <= 0.05
    low, high = binom.interval(0.999, 300, 0.05)
    assert low <= rejected <= high and low <= 300 - covered <= high, (rejected, covered)
    assert related > 290


@pytest.mark.parametrize(("unit", "other"), [(1e-200, 1.0), (1.0, 1e-200), (1e200, 1e200), (1e-12, 1e12)])
def test_no_unit_of_the_maps_counts(unit: float, other: float) -> None:
    """The correlation of a map of 1e-200 was infinite, and its p 1."""
    wanted = sx.compare_maps(BALL, Z, Z + X * Y, count=49, modes=36)
    found = sx.compare_maps(BALL, unit * Z, other * (Z + X * Y), count=49, modes=36)
    assert found.r == pytest.approx(wanted.r, abs=1e-9) and found.p == wanted.p
    assert found.interval == pytest.approx(wanted.interval, abs=1e-9)


def test_small_surfaces_are_compared_by_modes_and_told_why() -> None:
    small = sx.shape("icosphere", levels=2)
    rough = np.random.default_rng(0).standard_normal(162) + 3.0 * np.sign(small.mesh.vertices[:, 2] + 1e-9)
    with pytest.raises(ValueError, match=r"162 vertices are too few for variograms, take method='eigenstrapping'"):
        sx.null_maps(small, rough, 9, method="variogram")
    found = sx.compare_maps(small, np.sign(small.mesh.vertices[:, 2] + 1e-9), rough, count=49, modes=9)
    assert found.method == "eigenstrapping" and found.reason.endswith("but 162 vertices are too few for variograms.")
