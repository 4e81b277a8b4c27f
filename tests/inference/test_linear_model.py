"""t of a contrast against least squares, scipy's tests, and Freedman and Lane's procedure step by step."""

from __future__ import annotations

import numpy as np
import pytest
from reference import t_by_definition
from scipy.stats import ttest_1samp, ttest_ind

from surfexp.inference.linear_model import contrast_model
from surfexp.inference.rearrangements import permutations, sign_flips, unchanged

RANDOM = np.random.default_rng(0)
DATA = RANDOM.standard_normal((9, 30)) + 0.4
AGE = RANDOM.uniform(20, 80, 9)
SEX = np.array([0, 1, 0, 1, 1, 0, 0, 1, 0.0])
COVARIATES = np.column_stack([np.ones(9), SEX, AGE, AGE**2])
CONTRAST = np.array([0.0, 1.0, 0.0, 0.0])


def t_of(data: np.ndarray, design: np.ndarray, contrast: np.ndarray) -> np.ndarray:
    return contrast_model(data, design, contrast).t_maps(unchanged(len(data)))[0]


def test_t_is_scipys_in_one_and_two_samples() -> None:
    np.testing.assert_allclose(t_of(DATA, np.ones((9, 1)), np.ones(1)), ttest_1samp(DATA, 0.0).statistic, rtol=1e-10)
    groups = np.column_stack([SEX, 1.0 - SEX])
    wanted = ttest_ind(DATA[SEX == 1], DATA[SEX == 0]).statistic
    np.testing.assert_allclose(t_of(DATA, groups, np.array([1.0, -1.0])), wanted, rtol=1e-10)


@pytest.mark.parametrize("contrast", [[0, 1, 0, 0], [0, 0, 1, 0], [1, 0.5, 50, 2500], [0, 2, 0.1, 0]])
def test_t_is_that_of_least_squares(contrast: list[float]) -> None:
    wanted = t_by_definition(DATA, COVARIATES, np.array(contrast, dtype=float))
    np.testing.assert_allclose(t_of(DATA, COVARIATES, np.array(contrast, dtype=float)), wanted, rtol=1e-8)


def test_a_design_of_less_than_full_rank_keeps_what_can_be_estimated() -> None:
    double = np.column_stack([np.ones(9), SEX, 1.0 - SEX])
    wanted = ttest_ind(DATA[SEX == 1], DATA[SEX == 0]).statistic
    np.testing.assert_allclose(t_of(DATA, double, np.array([0.0, 1.0, -1.0])), wanted, rtol=1e-10)
    with pytest.raises(ValueError, match="cannot be estimated"):
        contrast_model(DATA, double, np.array([0.0, 1.0, 0.0]))


@pytest.mark.parametrize("kind", ["permutations", "flips"])
def test_rearrangements_are_those_of_freedman_and_lane(kind: str) -> None:
    """Residuals of the reduced model are rearranged, its fit is added, and the full model is fitted again."""
    reduced = np.delete(COVARIATES, 1, axis=1)
    fit = reduced @ np.linalg.lstsq(reduced, DATA, rcond=None)[0]
    single = np.arange(9)
    chosen = (
        sign_flips(single, 12, RANDOM)
        if kind == "flips"
        else permutations(single, np.zeros(9, dtype=int), COVARIATES, 12, RANDOM)
    )
    found = contrast_model(DATA, COVARIATES, CONTRAST).t_maps(chosen)
    for row, sources, signs in zip(found, chosen.sources, chosen.signs, strict=True):
        data = fit + signs[:, None] * (DATA - fit)[sources]
        np.testing.assert_allclose(row, t_by_definition(data, COVARIATES, CONTRAST), rtol=1e-7)


def test_whether_the_nuisance_holds_the_mean() -> None:
    assert contrast_model(DATA, COVARIATES, CONTRAST).has_mean
    assert contrast_model(DATA, np.column_stack([SEX, 1.0 - SEX]), np.array([1.0, -1.0])).has_mean
    assert not contrast_model(DATA, np.column_stack([SEX, 1.0 - SEX]), np.array([1.0, 0.0])).has_mean
    assert not contrast_model(DATA, np.ones((9, 1)), np.ones(1)).has_mean


def test_t_depends_on_neither_scale_nor_nuisance() -> None:
    wanted = t_of(DATA, COVARIATES, CONTRAST)
    moved = DATA * 10.0 ** np.linspace(-200, 200, 30)
    np.testing.assert_allclose(t_of(moved, COVARIATES, CONTRAST), wanted, rtol=1e-8)
    np.testing.assert_allclose(t_of(DATA + 3.0 * AGE[:, None], COVARIATES, CONTRAST), wanted, rtol=1e-6)


def test_data_that_leave_nothing_have_no_t_and_perfect_fits_have_equal_ones() -> None:
    data = np.column_stack([np.zeros(9), AGE, SEX, 5.0 * SEX + 2.0])
    found = t_of(data, COVARIATES, CONTRAST)
    assert (found[:2] == 0.0).all() and found[2] == pytest.approx(found[3]) and 1e5 < found[2] < 1e8


def test_mistakes_are_named() -> None:
    with pytest.raises(ValueError, match=r"\(9, p\) and \(p,\) are needed for 9 maps"):
        contrast_model(DATA, COVARIATES[:5], CONTRAST)
    with pytest.raises(ValueError, match="at least 5 are needed"):
        contrast_model(DATA[:4], COVARIATES[:4], CONTRAST)


@pytest.mark.parametrize("scale", [1e-140, 1e-12, 1e12, 1e140])
@pytest.mark.parametrize("tested", [1, 2])
def test_t_and_permutations_do_not_depend_on_the_units_of_covariates(scale: float, tested: int) -> None:
    design, contrast = COVARIATES[:, :3], np.eye(3)[tested]
    scaled = design * np.array([1.0, 1.0, scale])
    np.testing.assert_allclose(t_of(DATA, scaled, contrast), t_of(DATA, design, contrast), rtol=1e-8)
    drawn = [
        permutations(np.arange(7), np.zeros(7, dtype=int), rows[:7], 5040, np.random.default_rng(0))
        for rows in (design, scaled)
    ]
    assert len(drawn[0]) == len(drawn[1]) == 5040


def test_permutations_do_not_depend_on_the_origin_of_a_covariate() -> None:
    moments = 1.7e18 + 1e13 * np.arange(5.0)  # days in nanoseconds
    for rows in (moments, moments / 1e9, moments - 1.7e18):
        drawn = permutations(np.arange(5), np.zeros(5, dtype=int), rows[:, None], 5000, RANDOM)
        assert drawn.complete and len(drawn) == 120


def test_a_column_that_is_constant_to_rounding_tells_no_rows_apart() -> None:
    constant = 3.3 * (1.0 + 2e-15 * np.random.default_rng(0).standard_normal(6))
    with np.errstate(all="raise"):
        for first in (constant, np.zeros(6), np.full(6, 3.3)):
            drawn = permutations(np.arange(6), np.zeros(6, dtype=int), np.column_stack([first, SEX[:6]]), 5000, RANDOM)
            assert drawn.complete and len(drawn) == 20
