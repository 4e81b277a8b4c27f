"""Ratios of errors: units are paired, groups are drawn together, what failed is said."""

from __future__ import annotations

import numpy as np
import pytest

from surfexp.contract.member import Member
from surfexp.variational.solution import Solution
from surfexp_studies.smoothing.error_ratios import error_ratios, median_ratio, verdict


def solution(error: float, converged: bool = True) -> Solution:
    return Solution(np.zeros(1), 0.0, converged=converged, reason="", model="", solver="", metrics={"rmse": error})


def members(errors: dict[str, list[float]], groups: list[str]) -> dict[Member, Solution]:
    return {
        Member(f"{method} {place}", method, group): solution(error)
        for method, values in errors.items()
        for place, (error, group) in enumerate(zip(values, groups, strict=True))
    }


def test_ratios_are_medians_over_paired_units() -> None:
    errors = {"none": [1.0, 2.0, 4.0], "heat": [0.5, 1.0, 2.0], "variation": [0.25, 0.9, 1.0]}
    found = error_ratios(members(errors, ["a", "b", "c"]), "rmse", "heat", "none")
    assert found.rows == ("none", "heat", "variation")
    assert found.columns["to_reference"][:, 0].tolist() == [2.0, 1.0, 0.5]
    assert found.columns["to_baseline"][:, 0].tolist() == [1.0, 0.5, 0.25]
    # the interval of three groups reaches from the least to the largest of them
    assert found.columns["to_reference"][2].tolist() == [0.5, 0.5, 0.9]
    assert found.columns["verdict"].tolist() == [-1.0, 0.0, 1.0]
    assert found.metrics["groups"] == 3 and found.metrics["ratio variation"] == 0.5


def test_units_of_one_group_are_drawn_together() -> None:
    random = np.random.default_rng(0)
    group_effect, reached = 0.2, []
    for _ in range(200):
        ratios = np.repeat(1.0 + group_effect * random.standard_normal(8), 4)
        owners = np.repeat(np.arange(8), 4)
        draws = random.integers(8, size=(400, 8))
        _, low, high = median_ratio(ratios, owners, draws)
        alone = random.integers(32, size=(400, 32))
        _, low_alone, high_alone = median_ratio(ratios, np.arange(32), alone)
        reached.append((low <= 1.0 <= high, low_alone <= 1.0 <= high_alone))
    together, apart = np.mean(reached, axis=0)
    # the percentiles of a median of eight are a little too near; as 32 units of their own they are nearer still
    assert together > 0.8 and apart < together - 0.1


def test_the_interval_holds_the_central_95_per_cent() -> None:
    ratios = np.arange(1.0, 42.0)
    draws = np.random.default_rng(1).integers(41, size=(4000, 41))
    _, low, high = median_ratio(ratios, np.arange(41), draws)
    medians = np.median(ratios[draws], axis=1)
    assert (medians < low).mean() <= 0.025 <= (medians <= low).mean()
    assert (medians > high).mean() <= 0.025 <= (medians >= high).mean()


def test_what_failed_counts_in_no_ratio_and_leaves_no_verdict() -> None:
    found = members({"none": [1.0, 1.0], "heat": [0.5, 0.5]}, ["a", "b"])
    found = {m: (solution(0.1, False) if m.label == "heat 1" else s) for m, s in found.items()}
    table = error_ratios(found, "rmse", "none", "none")
    assert table.metrics["failed heat"] == 1 and table.metrics["ratio heat"] == 0.5
    assert np.isnan(table.columns["verdict"][1])
    assert np.isnan(median_ratio(np.array([np.nan]), np.array([0]), np.zeros((3, 1), dtype=int))).all()


def test_verdicts_have_a_margin() -> None:
    assert verdict((0.97, 0.96, 0.979), 0) == 1 and verdict((0.97, 0.96, 0.985), 0) == 0
    assert verdict((1.05, 1.021, 1.1), 0) == -1 and verdict((1.05, 1.01, 1.1), 0) == 0


def test_wrong_collections_are_refused() -> None:
    good = members({"none": [1.0], "heat": [0.5]}, ["a"])
    with pytest.raises(ValueError, match="'mean' is no method here, choose one of none, heat"):
        error_ratios(good, "rmse", "mean", "none")
    with pytest.raises(ValueError, match="they must be the same"):
        error_ratios(good | members({"other": [1.0]}, ["b"]), "rmse", "none", "none")
    with pytest.raises(ValueError, match="1 of 1 results of 'none' have no metric 'dice'"):
        error_ratios(good, "dice", "heat", "none")
