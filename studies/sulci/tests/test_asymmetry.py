"""Metrics of the first sulcus are those of the first sulcus."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from surfexp_studies.sulci.asymmetry import asymmetry_study


def test_metrics_are_those_of_the_first_sulcus() -> None:
    random = np.random.default_rng(0)
    left = random.normal(10.0, 1.0, (12, 3))
    right = left + random.normal(0.0, 0.3, (12, 3)) - [1.0, 0.0, 0.0]  # the first is longer on the left
    rows, columns, metrics = asymmetry_study({"whole": {"left": left, "right": right}}, draws=20)
    t, wilcoxon = stats.ttest_rel(left, right), stats.wilcoxon(left[:, 0], right[:, 0])
    assert rows == tuple(f"sulcus {k}, whole" for k in (1, 2, 3))
    assert metrics["difference, whole"] == columns["difference"][0] > np.abs(columns["difference"][1:]).max()
    assert metrics["p, whole"] == pytest.approx(3 * t.pvalue[0])  # Holm: the least of three is tripled
    assert metrics["p Wilcoxon, whole"] == pytest.approx(3 * wilcoxon.pvalue)
    assert metrics["least p elsewhere, whole"] == pytest.approx(columns["p_t_holm"][1:].min())
    assert metrics["p, whole"] < metrics["least p elsewhere, whole"] and metrics["pairs, whole"] == 12.0


def test_one_sulcus_alone_has_none_elsewhere() -> None:
    left = np.random.default_rng(0).normal(10.0, 1.0, (12, 1))
    right = left + np.random.default_rng(1).normal(0.0, 0.3, (12, 1))
    metrics = asymmetry_study({"whole": {"left": left, "right": right}}, draws=20)[2]
    assert metrics["least p elsewhere, whole"] == 1.0 and 0.0 < metrics["p, whole"] <= 1.0
