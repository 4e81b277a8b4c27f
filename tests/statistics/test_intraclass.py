"""ICC(2,1) against the published table, exact fractions and identities."""

from fractions import Fraction

import numpy as np
import pytest

from surfexp.statistics.intraclass import intraclass_correlation

# table 2 of Shrout and Fleiss (1979): six targets, four judges
TABLE = np.array([[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]], dtype=float)


def test_the_table_of_shrout_and_fleiss() -> None:
    # their table 3: sums of squares between targets 56.21, between judges 97.46, residual 15.29
    between, judges, rest = Fraction(1349, 24) / 5, Fraction(2339, 24) / 3, Fraction(367, 24) / 15
    assert [round(float(x), 2) for x in (between, judges, rest)] == [11.24, 32.49, 1.02]
    exact = (between - rest) / (between + 3 * rest + Fraction(4, 6) * (judges - rest))
    assert intraclass_correlation(TABLE) == pytest.approx(float(exact), abs=1e-14)
    assert round(float(exact), 2) == 0.29


def test_identities() -> None:
    rng = np.random.default_rng(0)
    people = rng.normal(size=(7, 1))
    assert intraclass_correlation(people + np.zeros(3)) == pytest.approx(1.0, abs=1e-14)
    # without rest ICC is B / (B + k J / n)
    shifts = np.array([0.0, 0.5, -1.0])
    between, judges = 3 * people.var(ddof=1), 7 * shifts.var(ddof=1)
    assert intraclass_correlation(people + shifts) == pytest.approx(between / (between + 3 / 7 * judges), abs=1e-13)
    for same in (TABLE[::-1], TABLE[:, ::-1], 3.0 * TABLE - 5.0):
        assert intraclass_correlation(same) == pytest.approx(intraclass_correlation(TABLE), abs=1e-13)
    noise = intraclass_correlation(rng.normal(size=(20000, 2)))
    assert abs(noise) < 0.03


def test_entries_are_taken_one_by_one_and_constant_ones_have_none() -> None:
    found = intraclass_correlation(np.stack([TABLE, np.full_like(TABLE, 2.0), TABLE[:, ::-1] ** 2], axis=2))
    assert found.shape == (3,) and np.isnan(found[1])
    assert found[0] == pytest.approx(float(intraclass_correlation(TABLE)))
    assert found[2] == pytest.approx(float(intraclass_correlation(TABLE**2)))


@pytest.mark.parametrize("table", [TABLE[:1], TABLE[:, :1], TABLE[0], np.where(TABLE == 9, np.nan, TABLE)])
def test_too_small_or_unknown_ratings_are_refused(table: np.ndarray) -> None:
    with pytest.raises(ValueError, match="ratings"):
        intraclass_correlation(table)
