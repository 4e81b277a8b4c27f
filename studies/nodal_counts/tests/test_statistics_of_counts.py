"""Tables of counts: agreement, change, trend, and what a signature refuses."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.spectrum.signature import Signature
from surfexp.statistics.statistic import Statistic
from surfexp_studies.nodal_counts.count_agreement import count_agreement, largest_change, moving_mean
from surfexp_studies.nodal_counts.nodal_trend import RECTANGLE_MEAN, nodal_trend, rectangle_trend


def test_agreement_is_counted() -> None:
    counts = np.arange(2.0, 62.0)
    wrong = counts.copy()
    wrong[40:] += 1.0
    found = count_agreement(Signature(counts), {"same": Signature(counts), "late": Signature(wrong)})
    assert found.metrics["all same"] == 1.0 and found.metrics["trusted same"] == 60.0
    assert found.metrics["first 20 late"] == 1.0 and found.metrics["all late"] == pytest.approx(40 / 60)
    assert 30 < found.metrics["trusted late"] <= 40 and found.metrics["all"] == pytest.approx(100 / 120)
    assert found.metrics["mean_error"] == pytest.approx(20 / 60 / 2)
    wrong[20:40] += 1.0
    after = count_agreement(Signature(counts), {"after 20": Signature(wrong)})
    assert after.metrics["first 20 after 20"] == 1.0 and after.metrics["all"] == pytest.approx(20 / 60)
    with pytest.raises(ValueError, match="at least 1 of 20"):
        count_agreement(Signature(counts[:5]), {"same": Signature(counts)})


def test_moving_mean() -> None:
    assert moving_mean(np.ones(50)) == pytest.approx(np.ones(50))
    assert moving_mean(np.arange(100.0))[50] == pytest.approx(49.5)


def test_change_is_relative() -> None:
    found = largest_change(Signature(np.array([1.0, 2.0])), {"b": Signature(np.array([1.0, 4.0, 9.0]))})
    assert found.metrics == {"largest": 0.5, "mean": 0.25} and found.rows == ("b",)


def rectangle_counts(aspect: float, number: int) -> np.ndarray:
    m, n = np.meshgrid(np.arange(1, 400), np.arange(1, 400), indexing="ij")
    order = np.argsort((m**2 / aspect**2 + n**2).ravel())[:number]
    return np.asarray((m * n).ravel()[order], dtype=float)


def test_trend_of_a_rectangle_is_the_known_one() -> None:
    found = nodal_trend(rectangle_counts(2.1**0.5, 4000), "rectangle").metrics
    assert found["mean_ratio"] == pytest.approx(RECTANGLE_MEAN, rel=0.06)
    assert found["exponent"] == pytest.approx(1.0, abs=0.15) and found["largest_ratio"] < found["pleijel"]
    assert "over_smooth" not in found
    few = nodal_trend(np.arange(2.0, 27.0))
    assert few.columns["mode"] == pytest.approx([6.5, 16.5]) and few.columns["count"] == pytest.approx([6.5, 16.5])
    assert few.columns["ratio"] == pytest.approx(1.0) and few.columns["running mean"] == pytest.approx(1.0)
    with pytest.raises(ValueError, match="at least 20"):
        nodal_trend(np.ones(3))


def test_numbers_start_with_the_first_mode_of_all() -> None:
    fixed, free = np.ones(40), np.full(40, 2.0)
    assert nodal_trend(fixed).metrics["largest_ratio"] == pytest.approx(1 / 21)
    assert nodal_trend(free).metrics["largest_ratio"] == pytest.approx(2 / 22)
    assert nodal_trend(fixed).columns["ratio"][0, 2] == nodal_trend(free).columns["ratio"][0, 2] == 1.0


@pytest.mark.parametrize("aspect", [1.0, 2.1**0.5, 3.0, np.pi])
def test_smooth_trend_of_rectangles_is_their_mean(aspect: float) -> None:
    counts = rectangle_counts(aspect, 20000)
    numbers = np.arange(1.0, 20001.0)
    smooth = rectangle_trend(numbers, aspect, 2.0 * aspect + 2.0)
    off = [(counts / numbers)[n : 2 * n].mean() / smooth[n : 2 * n].mean() - 1.0 for n in (150, 1000, 10000)]
    assert np.abs(off) == pytest.approx(0.0, abs=0.012) and abs(off[-1]) < 1e-3
    assert smooth[-1] / RECTANGLE_MEAN - 1.0 == pytest.approx(
        1.5 * (2.0 * aspect + 2.0) / np.sqrt(4.0 * np.pi * aspect * 20000), rel=0.05
    )
    found = nodal_trend(counts[:300], "rectangle", aspect, 2.0 * aspect + 2.0)
    assert "smooth mean" in found.columns
    for known in ({}, {"area": aspect}, {"perimeter": 2.0 * aspect + 2.0}):
        assert "smooth mean" not in nodal_trend(counts[:300], "rectangle", **known).columns
    assert found.metrics["over_smooth"] == pytest.approx(1.0, abs=0.02)
    assert found.metrics["over_rectangle"] > 1.08 and len(found.columns["smooth mean"]) == 30


def test_smooth_trend_knows_no_unit() -> None:
    numbers = np.arange(1.0, 50.0)
    assert rectangle_trend(numbers, 2.0, 6.0) == pytest.approx(rectangle_trend(numbers, 200.0, 60.0))


def test_columns_have_one_length() -> None:
    with pytest.raises(ValueError, match="must be equal"):
        Statistic("table", {"a": np.zeros(3), "b": np.zeros(2)})
    with pytest.raises(ValueError, match="must be equal"):
        Statistic("table", {"a": np.zeros(3)}, ("one",))
