"""The comparison of two runs counts what differs, and calls energies beyond their gaps wrong."""

from __future__ import annotations

import pytest

from audits.torture.determinism import Run, compared

ROW = {"comparison": "a", "leaf": "b", "solver.name": "pd", "operator.name": "fem", "energy": "100.0", "gap": "0.5",
       "converged": "1.0", "failure": "", "seconds": "3.0", "rmse": "2.0", "relative_gap": ""}  # fmt: skip


def of(stored: str = "x", code: int = 0, **changed: str) -> Run:
    return Run("other", code, [ROW | changed], {"a": "x", "b": stored}, 1.0)


@pytest.mark.parametrize(
    ("other", "good", "said"),
    [
        (of(), True, "| the same | 2 of 2 | 0 |  | 0 |"),
        (of(stored="y", seconds="9.0"), True, "| the same | 1 of 2 | 0 |"),
        (of(rmse="2.002"), True, "| 1.0e-03 | rmse of pd, fem | 0 |"),
        (of(energy="100.4"), True, "energy of pd, fem | 0 |"),
        (of(energy="100.6"), False, "energy of pd, fem | 1 |"),
        (of(energy="100.6", gap="0.7"), True, "| 0 |"),
        (of(converged="0.0"), False, "**others**"),
        (of(failure="no memory"), False, "**others**"),
        (of(code=3), False, "**others**"),
        (Run("other", 0, [], {}, 1.0), False, "0 of 2"),
    ],
)
def test_what_differs_is_counted(other: Run, good: bool, said: str) -> None:
    row, fits = compared(of(stored="x"), other)
    assert fits is good and said in row
