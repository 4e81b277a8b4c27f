"""Tables of counts: agreement, change, trend, and what a signature refuses."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.spectrum.signature import Signature
from surfexp.statistics.count_agreement import count_agreement, largest_change, moving_mean
from surfexp.statistics.nodal_trend import RECTANGLE_MEAN, nodal_trend
from surfexp.statistics.statistic import Statistic


def test_agreement_is_counted() -> None:
    counts = np.arange(2.0, 62.0)
    wrong = counts.copy()
    wrong[40:] += 1.0
    found = count_agreement(Signature(counts), {"same": Signature(counts), "late": Signature(wrong)})
    assert found.metrics["all same"] == 1.0 and found.metrics["trusted same"] == 60.0
    assert found.metrics["first 20 late"] == 1.0 and found.metrics["all late"] == pytest.approx(40 / 60)
    assert 30 < found.metrics["trusted late"] <= 40 and found.metrics["all"] == pytest.approx(100 / 120)
    assert found.metrics["mean_error"] == pytest.approx(20 / 60 / 2)
    with pytest.raises(ValueError, match="at least 1 of 20"):
        count_agreement(Signature(counts[:5]), {"same": Signature(counts)})


def test_moving_mean() -> None:
    assert moving_mean(np.ones(50)) == pytest.approx(np.ones(50))
    assert moving_mean(np.arange(100.0))[50] == pytest.approx(49.5)


def test_change_is_relative() -> None:
    found = largest_change(Signature(np.array([1.0, 2.0])), {"b": Signature(np.array([1.0, 4.0, 9.0]))})
    assert found.metrics == {"largest": 0.5, "mean": 0.25} and found.rows == ("b",)


def test_trend_of_a_rectangle_is_the_known_one() -> None:
    m, n = np.meshgrid(np.arange(1, 200), np.arange(1, 200), indexing="ij")
    order = np.argsort((m**2 / 2.1 + n**2).ravel())[:4000]
    found = nodal_trend((m * n).ravel()[order].astype(float), "rectangle").metrics
    assert found["mean_ratio"] == pytest.approx(RECTANGLE_MEAN, rel=0.06)
    assert found["exponent"] == pytest.approx(1.0, abs=0.15) and found["largest_ratio"] < found["pleijel"]
    few = nodal_trend(np.arange(1.0, 26.0))
    assert few.columns["mode"] == pytest.approx([5.5, 15.5]) and few.columns["count"] == pytest.approx([5.5, 15.5])
    assert few.columns["ratio"][0, 1:] == pytest.approx([1 / 2, 10 / 11])
    assert few.columns["running mean"][1] == pytest.approx(np.mean(np.arange(1, 21) / np.arange(2, 22)))
    with pytest.raises(ValueError, match="at least 20"):
        nodal_trend(np.ones(3))


def test_columns_have_one_length() -> None:
    with pytest.raises(ValueError, match="must be equal"):
        Statistic("table", {"a": np.zeros(3), "b": np.zeros(2)})
    with pytest.raises(ValueError, match="must be equal"):
        Statistic("table", {"a": np.zeros(3)}, ("one",))
