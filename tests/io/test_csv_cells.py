"""No cell that we write is a formula, and every number stays a number."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from surfexp.commands.exporting.writers import write_csv
from surfexp.io.csv_cells import STARTS_A_FORMULA, cell
from surfexp.io.text_tables import write_table
from surfexp.lab.plan.plan import Leaf
from surfexp.records.table import Row, to_csv

EVIL = "=HYPERLINK(1)"


@given(st.sampled_from(STARTS_A_FORMULA), st.text())
def test_text_never_starts_a_formula(start: str, rest: str) -> None:
    written = cell(start + rest)
    try:
        float(start + rest)
    except ValueError:
        assert written == f"'{start}{rest}"
    else:
        assert written == start + rest


@given(st.floats(allow_nan=False))
def test_numbers_stay(number: float) -> None:
    assert cell(number) == number and cell(repr(number)) == repr(number) and cell(f"{number:+.3e}") == f"{number:+.3e}"


def test_every_table_is_written_so(tmp_path: Path) -> None:
    write_csv(tmp_path / "export.csv", (EVIL, "value"), [(EVIL, -0.5)])
    write_table(tmp_path / "maps.csv", {EVIL: np.array([-0.5])})
    row = Row(Leaf("key", "none", {"comparison": EVIL}), {"solver.name": EVIL}, {"gap": -0.5}, 0.0, failure=EVIL)
    (tmp_path / "report.csv").write_text(to_csv([row]))
    for file in tmp_path.iterdir():
        with file.open(newline="") as stream:
            found = [entry for line in csv.reader(stream) for entry in line]
        assert "-0.5" in found and f"'{EVIL}" in found and EVIL not in found, file.name
