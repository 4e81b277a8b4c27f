"""Rankings: ranks against a hand count, tests against permutations, groups and profiles by their definitions, the page."""

from __future__ import annotations

import dataclasses
import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from audits.benchmarks.synthetic_results import fill, plan_of
from surfexp.contract.metric import Metric
from surfexp.lab.plan.plan import Leaf
from surfexp.records.comparison import Comparison
from surfexp.records.table import Row
from surfexp.report.page import write_report
from surfexp.report.ranking.drawing import draw
from surfexp.report.ranking.profile import has_profile, profiles
from surfexp.report.ranking.ranking import _interval, rank
from surfexp.report.ranking.trials import FEWEST_DATA, Trials, _names, trials_of

METRICS = {"rmse": Metric("error", "mm", "lower"), "dice": Metric("overlap", "", "higher"), "area": Metric("area")}


def trials(values: np.ndarray, better: str = "lower") -> Trials:
    return Trials("rmse", better, "mm", tuple(f"m{k}" for k in range(values.shape[1])), values)


def row(method: str, problem: int, rmse: float, *, target: str = "solver", **more: object) -> Row:
    parameters = {
        "image.seed": problem,
        "solver.name": method,
        **{f"solver.{key}": value for key, value in more.items()},
    }
    metrics = {"rmse": rmse, "dice": -rmse, "area": 1.0 + problem, "converged": 1.0}
    leaf = Leaf(f"{method}{problem}", "", {"target": target, "timing": False})
    return Row(leaf, parameters, metrics, 1.0, data=frozenset([f"image {problem}"]))


def group(rows: list[Row]) -> Comparison:
    return Comparison("", "", rows, [], METRICS)


values = arrays(np.float64, st.tuples(st.integers(6, 9), st.integers(2, 4)), elements=st.integers(1, 6).map(float))


@settings(max_examples=3, deadline=None)
@given(values)
def test_ranks_are_counted_and_higher_is_lower_of_the_negative(table: np.ndarray) -> None:
    found = rank(trials(table))
    # a rank is one more than the number of better ones, plus half the other equal ones
    smaller = (table[:, :, None] > table[:, None, :]).sum(axis=2)
    equal = (table[:, :, None] == table[:, None, :]).sum(axis=2) - 1
    assert np.allclose(found.ranks, (1 + smaller + equal / 2).mean(axis=0)[found.order])
    assert (np.diff(found.ranks) >= 0).all()
    mirrored = rank(trials(-table, "higher"))
    assert np.array_equal(mirrored.order, found.order) and mirrored.groups == found.groups
    assert np.allclose(mirrored.difference, -found.difference, equal_nan=True)
    assert np.allclose(mirrored.p, found.p) and np.allclose(mirrored.low, -found.high, equal_nan=True)


@settings(max_examples=3, deadline=None)
@given(values)
def test_groups_are_the_longest_runs_that_no_test_tells_apart(table: np.ndarray) -> None:
    found = rank(trials(table))
    m = table.shape[1]
    same = {
        (i, j)
        for i, j in itertools.combinations(range(m), 2)
        if (found.p[i : j + 1, i : j + 1] > 0.05).all()  # diagonal: 1
    }
    longest = {(i, j) for i, j in same if not any(a <= i and j <= b and (a, b) != (i, j) for a, b in same)}
    assert set(found.groups) == longest


def test_a_pair_has_the_p_value_of_all_signs() -> None:
    differences = np.array([0.3, -0.1, 0.8, 1.1, 0.6, 0.45, 0.9])
    table = np.column_stack([np.ones(7), 1.0 + differences])
    sizes = np.argsort(np.argsort(np.abs(differences))) + 1.0
    statistic = abs((sizes * np.sign(differences)).sum())
    every = [abs(sizes @ signs) for signs in itertools.product([-1.0, 1.0], repeat=7)]
    assert rank(trials(table)).p[0, 1] == pytest.approx(np.mean(np.array(every) >= statistic - 1e-9))


def test_friedman_and_holm_by_their_formulas() -> None:
    table = np.random.default_rng(3).normal([0.0, 0.2, 1.5, 3.0], 1.0, (9, 4))
    found = rank(trials(table))
    n, m = table.shape
    from scipy.stats import chi2, wilcoxon

    statistic = 12 * n / (m * (m + 1)) * ((found.ranks - (m + 1) / 2) ** 2).sum()
    assert found.p_friedman == pytest.approx(chi2.sf(statistic, m - 1))
    ordered = table[:, found.order]
    raw = sorted((wilcoxon(ordered[:, i] - ordered[:, j]).pvalue, i, j) for i, j in itertools.combinations(range(m), 2))
    running = 0.0
    for place, (value, i, j) in enumerate(raw):
        running = max(running, min(1.0, (len(raw) - place) * value))
        assert found.p[i, j] == pytest.approx(running)


def test_an_interval_covers_the_true_difference_as_often_as_it_says() -> None:
    random = np.random.default_rng(0)
    ends = [_interval(5.0 + random.normal(0.0, 1.0, 8)) for _ in range(2000)]
    hits = np.mean([low <= 5.0 <= high for _, low, high in ends])
    assert 0.935 <= hits <= 0.965  # 95 %, give or take three standard deviations
    table = np.column_stack([np.zeros(8), 5.0 + random.normal(0.0, 1.0, 8)])
    found = rank(trials(table))
    assert (found.difference[1], found.low[1], found.high[1]) == pytest.approx(_interval(table[:, 1]))


def test_what_failed_ranks_last_and_has_no_number() -> None:
    table = np.column_stack([np.full(7, 2.0), np.full(7, 1.0)])
    table[:5, 1] = np.nan
    found = rank(trials(table))
    assert found.methods == ("m0", "m1") and found.failed == (0, 5)
    assert found.mean.tolist() == [2.0, 1.0]
    assert found.difference[1] == -1.0  # over the two that both solved
    # of the signs of seven ranks, five of which are tied above the other two: every one counted
    sizes = np.array([5.0] * 5 + [1.5] * 2)
    every = np.array([abs(sizes @ signs) for signs in itertools.product([-1.0, 1.0], repeat=7)])
    assert found.p[0, 1] == pytest.approx(np.mean(every >= 5 * 5.0 - 2 * 1.5 - 1e-9))


def test_a_method_that_failed_everywhere_is_told_apart_from_one_that_did_not() -> None:
    table = np.column_stack([1.0 + np.arange(10.0), np.full(10, np.nan), np.full(10, np.nan)])
    found = rank(trials(table))
    assert found.p[0, 1] == found.p[0, 2] == pytest.approx(3 * 2.0**-9) and found.p[1, 2] == 1.0
    assert found.groups == ((1, 2),)


@settings(max_examples=60, deadline=None)
@given(values, st.integers(0, 10**6))
def test_profiles_count_problems_within_a_factor(table: np.ndarray, seed: int) -> None:
    random = np.random.default_rng(seed)
    table = np.where(random.uniform(size=table.shape) < 0.2, np.nan, table)
    factors, shares = profiles(trials(table))
    assert factors[0] == 1.0 and (np.diff(factors) > 0).all() and (np.diff(shares, axis=0) >= 0).all()
    for factor, share in zip(factors, shares, strict=True):
        for k in range(table.shape[1]):
            best = [np.nanmin(line) if not np.isnan(line).all() else np.nan for line in table]
            within = [line[k] <= factor * least * (1 + 1e-12) for line, least in zip(table, best, strict=True)]
            assert share[k] == pytest.approx(np.mean(within))
    assert shares[-1].tolist() == pytest.approx((~np.isnan(table)).mean(axis=0).tolist())


def test_no_profile_of_what_may_be_negative_or_is_good_when_high() -> None:
    assert not has_profile(trials(np.array([[1.0, -1.0]] * 6)))
    with pytest.raises(ValueError, match="has no profile"):
        profiles(trials(np.ones((6, 2)), "higher"))


def test_methods_and_problems_are_found_in_a_table() -> None:
    rows = [row(name, k, 1.0 + k + offset) for k in range(7) for name, offset in (("rof", 0.5), ("tv_l1", 0.0))]
    found = {item.metric: item for item in trials_of(group(rows))}
    assert set(found) == {"rmse", "dice"}  # area has no good direction, converged and seconds are no merit here
    assert found["rmse"].methods == ("rof", "tv l1")
    assert np.array_equal(found["rmse"].values, np.add.outer(np.arange(7.0), [1.5, 1.0]))
    assert rank(found["rmse"]).methods[0] == "tv l1" and rank(found["dice"]).methods[0] == "tv l1"


def test_a_tolerance_is_a_part_of_the_problem_and_no_sample() -> None:
    rows = [
        row(name, k, 1.0 + k + tolerance, tolerance=tolerance)
        for k in range(6)
        for tolerance in (0.1, 0.2)
        for name in ("rof", "tv_l1")
    ]
    rows[0].metrics["rmse"] = 0.5
    (found, _) = trials_of(group(rows))
    assert found.methods == ("rof", "tv l1") and found.values.shape == (12, 2)
    assert found.samples.tolist() == np.repeat(range(6), 2).tolist()
    assert not trials_of(group(rows[:-4]))  # ten problems, five data


def test_tests_take_what_is_of_the_same_data_as_one_sample() -> None:
    random = np.random.default_rng(5)
    table = random.normal([0.0, 0.4, 0.5], 1.0, (7, 3))
    thrice = np.repeat(table, 3, axis=0)
    alone, found = rank(trials(table)), rank(dataclasses.replace(trials(thrice), data=tuple(np.repeat(range(7), 3))))
    assert np.allclose(found.p, alone.p) and found.p_friedman == pytest.approx(alone.p_friedman)
    assert np.allclose([found.low, found.high], [alone.low, alone.high], equal_nan=True)
    assert rank(trials(thrice)).p_friedman < 0.5 * alone.p_friedman  # as if each tolerance were a sample


def test_a_method_that_solves_one_tolerance_of_each_is_no_better_than_one_that_solves_the_other() -> None:
    table = np.array([[1.0, np.nan], [np.nan, 1.0]] * 7)
    found = rank(dataclasses.replace(trials(table), data=tuple(np.repeat(range(7), 2))))
    assert found.p[0, 1] == 1.0 and np.isnan(found.difference[1])


def test_what_is_not_a_comparison_of_methods_has_no_ranking() -> None:
    rows = [row(name, k, 1.0 + k + len(name)) for k in range(7) for name in ("rof", "tv_l1")]
    assert trials_of(group(rows))
    assert not trials_of(group(rows[: 2 * (FEWEST_DATA - 1)]))
    assert not trials_of(group([item for item in rows if item.parameters["solver.name"] == "rof"]))
    assert not trials_of(group([*rows, row("rof", 0, 3.0)]))  # the same method twice on a problem
    statistic = [
        dataclasses.replace(item, leaf=Leaf("", "", {"target": "statistic", "timing": False})) for item in rows
    ]
    assert not trials_of(group(statistic))
    constant = [row(name, k, 1.0) for k in range(7) for name in ("rof", "tv_l1")]
    assert not trials_of(group(constant))


def test_a_method_tried_on_few_problems_is_left_out_and_named() -> None:
    rows = [row(name, k, 1.0 + k + len(name)) for k in range(8) for name in ("rof", "tv_l1")]
    rows += [row("newton", k, 0.1) for k in range(3)]
    (found, _) = trials_of(group(rows))
    assert found.methods == ("rof", "tv l1") and found.left_out == ("newton",) and len(found.values) == 8


def test_rows_that_failed_or_did_not_converge_are_not_solved() -> None:
    rows = [row(name, k, 1.0 + k + len(name)) for k in range(8) for name in ("rof", "tv_l1")]
    rows[0].failure = "MemoryError"
    rows[3].metrics["converged"] = 0.0
    (found, _) = trials_of(group(rows))
    assert found.failed == (1, 1) and np.isnan(found.values[0, 0]) and np.isnan(found.values[1, 1])


def test_solvers_certified_for_one_energy_are_ranked_by_seconds_alone() -> None:
    rows = [row(name, k, 1.0 + k + len(name)) for k in range(7) for name in ("rof", "tv_l1")]
    for place, item in enumerate(rows):
        item.metrics["relative_gap"] = 1e-5
        item.seconds = 1.0 + place
    assert not trials_of(group(rows))
    timed = [dataclasses.replace(item, leaf=Leaf("", "", {"target": "solver", "timing": True})) for item in rows]
    (found,) = trials_of(group(timed))
    assert (found.metric, found.unit) == ("seconds", "s") and found.values[0].tolist() == [1.0, 2.0]
    for item in timed:
        item.parameters["operator.name"] = "fem" if item.parameters["solver.name"] == "rof" else "libigl"
    assert {found.metric for found in trials_of(group(timed))} == {"rmse", "dice", "seconds"}


def test_a_picture_is_the_same_twice_and_holds_names_as_text() -> None:
    table = np.random.default_rng(0).lognormal(size=(8, 3)) * [1.0, 2.0, 9.0]
    named = dataclasses.replace(trials(table), methods=("a <script>", "b", "c"))
    picture = draw(rank(named))
    assert picture == draw(rank(named))
    assert "a &lt;script&gt;" in picture and "<script" not in picture
    assert "times the best" in picture and "times the best" not in draw(rank(trials(-table)))
    assert "times the best" not in draw(rank(trials(1.0 + 0.01 * np.argsort(table, axis=1))))


def test_the_page_shows_the_ranking_and_drops_an_old_picture(tmp_path: Path) -> None:
    race = {
        "experiment": "race",
        "columns": ["rmse"],
        "surface": "cup",
        "image": {"name": "picture", "noise": 40.0},
        "solver": "primal_dual",
        "model": "rof",
        "grid": {"image.seed": list(range(6)), "operator": ["fem", "libigl"]},
    }
    plan = plan_of(race, tmp_path)
    fill(plan, tmp_path)
    stale = tmp_path / "race" / "figures" / "ranking-0-7.svg"
    stale.parent.mkdir(parents=True)
    stale.write_text("")
    page = (write_report(plan, tmp_path) / "report.html").read_text()
    assert "Ranked by rmse" in page and "On the 6 problems" in page and "libigl" in page
    assert not stale.exists() and "</svg>" in (stale.parent / "ranking-0-0.svg").read_text()


def test_a_method_is_named_by_what_tells_it_apart() -> None:
    rows = [{"solver.name": "chosen smoothing", "solver.method": method} for method in ("heat flow", "total variation")]
    modes = {"solver.name": "chosen modes"}
    assert _names([*rows, modes]) == ["heat flow", "total variation", "chosen modes"]
    steps = [{"solver.name": name, "solver.steps": f"steps {count}"} for name in ("a", "b") for count in (1, 2)]
    assert _names(steps) == ["a, steps 1", "a, steps 2", "b, steps 1", "b, steps 2"]
    assert _names([{"solver.name": "a"}, {"solver.name": "b"}]) == ["a", "b"]
