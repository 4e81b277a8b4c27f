"""Colour scales: limits, centre, clipping and missing values."""

from __future__ import annotations

import matplotlib
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from surfexp.figures.colormap import MISSING, ColorScale

VALUES = np.append(np.linspace(-1.0, 3.0, 401), np.nan)


def test_robust_limits_are_percentiles_of_the_finite_values() -> None:
    assert ColorScale().fitted(VALUES).limits == pytest.approx((-0.96, 2.96))
    assert ColorScale(percentiles=(0.0, 100.0)).fitted(VALUES).limits == (-1.0, 3.0)
    assert ColorScale(limits=(0.0, 255.0)).fitted(VALUES).limits == (0.0, 255.0)


def test_zero_is_the_middle_of_a_diverging_map() -> None:
    scale = ColorScale(colormap="RdBu_r").fitted(VALUES)
    assert scale.limits == pytest.approx((-2.96, 2.96))
    assert np.allclose(scale.rgb(np.array(0.0)), matplotlib.colormaps["RdBu_r"](0.5)[:3])


def test_values_of_one_sign_have_no_color_that_means_zero() -> None:
    thickness = np.linspace(1.0, 4.0, 50)
    for values, ends in ((thickness, (1.0, 4.0)), (-thickness, (-4.0, -1.0))):
        found = ColorScale(colormap="PuOr_r", percentiles=(0.0, 100.0)).fitted(values)
        assert not found.diverging and found.limits == ends
        assert found.position(values).min() == 0.0 and found.position(values).max() == 1.0
    assert ColorScale(colormap="PuOr_r").fitted(thickness - 1.5).diverging
    assert ColorScale(colormap="PuOr_r", limits=(1.0, 4.0)).fitted(thickness).diverging


def test_every_diverging_map_of_matplotlib_is_known() -> None:
    # white, black or grey in the middle, and two hues at the ends
    for name in ("RdBu", "coolwarm", "seismic", "PuOr_r", "vanimo"):
        assert ColorScale(colormap=name).diverging
    for name in ("viridis", "gray", "magma_r"):
        assert not ColorScale(colormap=name).diverging


@given(arrays(float, 20, elements=st.floats(-1e6, 1e6)))
def test_limits_are_always_increasing_and_shares_add_up(values: np.ndarray) -> None:
    scale = ColorScale(percentiles=(10.0, 90.0)).fitted(values)
    assert scale.limits is not None and scale.limits[0] < scale.limits[1]
    below, above = scale.share_beyond(values)
    assert below == np.mean(values < scale.limits[0]) and above == np.mean(values > scale.limits[1])
    assert below + above <= 0.21


def test_colours_are_those_of_the_map_and_clip_at_its_ends() -> None:
    scale = ColorScale(limits=(2.0, 4.0))
    colors = scale.rgb(np.array([2.0, 3.0, 4.0, -9.0, 9.0, np.nan]))
    assert np.allclose(colors[:3], matplotlib.colormaps["viridis"]([0.0, 0.5, 1.0])[:, :3])
    assert (colors[3] == colors[0]).all() and (colors[4] == colors[2]).all()
    assert tuple(colors[5]) == MISSING
    assert (scale.table()[[0, -1]] == colors[[0, 2]]).all()


def test_without_finite_values_there_are_limits_still() -> None:
    assert ColorScale().fitted(np.full(3, np.nan)).limits == (-0.5, 0.5)
    assert ColorScale().fitted(np.full(3, 7.0)).limits == (6.5, 7.5)


def test_title_carries_the_unit() -> None:
    assert ColorScale("mean curvature", "1/mm").title == "mean curvature (1/mm)"
    assert ColorScale("grey value").title == "grey value"


def test_mistakes_are_named() -> None:
    with pytest.raises(ValueError, match="'virdis' is unknown to matplotlib, the nearest name is 'viridis'"):
        ColorScale(colormap="virdis")
    with pytest.raises(ValueError, match=r"\(1\.0, 1\.0\)"):
        ColorScale(limits=(1.0, 1.0))
    with pytest.raises(ValueError, match=r"\(5, 101\)"):
        ColorScale(percentiles=(5, 101))
    with pytest.raises(ValueError, match="'depth' has no limits yet"):
        ColorScale("depth").rgb(VALUES)


@pytest.mark.parametrize("value", [0.0, 1e7, -1e15, 1e16, -1e300])
def test_a_constant_lies_in_the_middle_of_limits_that_differ(value: float) -> None:
    scale = ColorScale().fitted(np.full(5, value))
    assert scale.limits is not None and scale.limits[0] < value < scale.limits[1]
    assert scale.position(np.array([value])) == pytest.approx(0.5)
