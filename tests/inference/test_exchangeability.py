"""What a model and blocks allow: when p-values are exact, what a slope needs, what is said of the number of rearrangements."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from surfexp.inference.exchangeability import allowed_rearrangements, keeps_nuisance, least_p
from surfexp.inference.linear_model import ContrastModel, contrast_model
from surfexp.inference.rearrangements import Rearrangements, sign_flips, unchanged

RANDOM = np.random.default_rng(0)
DATA = RANDOM.standard_normal((6, 4))
ONES, AGE = np.ones(6), RANDOM.uniform(20.0, 80.0, 6)
SEX = np.array([0.0, 0.0, 1.0, 1.0, 0.0, 1.0])
PAIRS = np.array([0, 1, 0, 1, 2, 2])
OF_PAIRS = [SEX, *(k == PAIRS for k in range(3))]


def allowed(
    columns: list[np.ndarray], contrast: list[float], **given: Any
) -> tuple[ContrastModel, Rearrangements, str]:
    design = np.column_stack(columns).astype(float)
    model = contrast_model(given.pop("data", DATA[: len(design)]), design, np.array(contrast))
    asked = {"blocks": None, "exchange": "within", "rearrange": "auto", "count": 1000} | given
    chosen, words = allowed_rearrangements(model, design, **asked, random=np.random.default_rng(0))
    return model, chosen, words


@pytest.mark.parametrize(
    ("columns", "contrast", "given", "exact"),
    [
        ([ONES], [1], {}, True),
        ([ONES, AGE - AGE.mean()], [1, 0], {}, False),
        ([SEX, 1.0 - SEX], [1, -1], {}, True),
        ([ONES, AGE], [0, 1], {}, True),
        ([ONES, AGE, SEX], [0, 0, 1], {}, False),
        (OF_PAIRS, [1, 0, 0, 0], {"blocks": PAIRS}, True),
        (OF_PAIRS, [1, 0, 0, 0], {}, False),
        ([ONES, [1, 1, -1, -1, 0, 0]], [1, 0], {"blocks": [*"aabbcc"], "exchange": "whole"}, False),
        ([ONES, [1, -1, 0, 0, 0, 0]], [1, 0], {"blocks": [*"aabbcc"], "exchange": "whole"}, True),
        ([ONES, SEX, [1, 2, 3, 1, 2, 3]], [0, 1, 0], {"blocks": [*"aaabbb"], "exchange": "whole"}, True),
    ],
)
def test_complete_rearrangements_are_exact_where_the_nuisance_stays(
    columns: list[np.ndarray], contrast: list[float], given: dict, exact: bool
) -> None:
    """Then rearranged data and rearranged residuals have one t, whatever the nuisance adds to the data."""
    columns = [np.asarray(column, dtype=float) for column in columns]
    model, chosen, _ = allowed(columns, contrast, **given)
    assert chosen.complete and keeps_nuisance(model, chosen) == exact
    design = np.column_stack(columns)
    moved = [signs[:, None] * DATA[sources] for sources, signs in zip(chosen.sources, chosen.signs, strict=True)]
    again = [contrast_model(one, design, np.array(contrast, float)).t_maps(unchanged(6))[0] for one in moved]
    assert np.allclose(again, model.t_maps(chosen)) == exact


def test_whole_blocks_need_blocks() -> None:
    with pytest.raises(ValueError, match="exchange = 'whole' without blocks: give blocks"):
        allowed([ONES, AGE], [0, 1], exchange="whole")


def test_a_slope_needs_a_constant() -> None:
    """The design age alone tested, by flips, a line through 0: every map that is not 0 in the mean has one."""
    with pytest.raises(
        ValueError, match=r"the design has no constant: .* add a column of ones, .* or choose rearrange = 'flip'"
    ):
        allowed([AGE], [1])
    with pytest.raises(ValueError, match="no constant"):
        allowed([AGE, SEX], [1, 0])
    assert allowed([AGE], [1], rearrange="flip")[2] == "all 64 sign flips that differ"
    _, _, words = allowed([ONES, AGE], [0, 1])
    assert words == "all 720 permutations that differ"
    # a line that fits maps with a mean is not found by the slope
    far = contrast_model(DATA + 100.0, np.column_stack([ONES, AGE]), np.array([0.0, 1.0]))
    near = contrast_model(DATA, np.column_stack([ONES, AGE]), np.array([0.0, 1.0]))
    np.testing.assert_allclose(far.t_maps(unchanged(6)), near.t_maps(unchanged(6)), rtol=1e-6)


def test_many_flips_are_a_power() -> None:
    """2 to the 15,000 has more digits than Python writes."""
    for size, words in ((12, "100 of 4,096"), (19, "100 of 524,288"), (20, "100 of 2^20"), (15000, "100 of 2^15000")):
        data = np.ones((size, 1)) + np.arange(size)[:, None] % 2
        assert allowed([np.ones(size)], [1], data=data, count=100)[2] == f"{words} sign flips"


def test_no_p_is_under_the_share_of_flips_that_only_turn_the_statistic_around() -> None:
    """Of five observations flips have cosines of 1, 3/5, 1/5 and their negatives with the mean."""
    model = contrast_model(np.arange(1.0, 6.0)[:, None], np.ones((5, 1)), np.ones(1))
    chosen = sign_flips(np.arange(5), 32, np.random.default_rng(0))
    assert (least_p(model, chosen, True), least_p(model, chosen, False)) == (2.0 / 32.0, 1.0 / 32.0)
