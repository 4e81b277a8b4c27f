"""The study of levels: its noise, its designs, its table, and that it goes on where it stopped."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from audits.benchmarks.permutation_levels import DESIGNS, MAPS, WIDTHS, fields, interval, levels_of, main, table_of


def test_fields_have_variance_1_on_average() -> None:
    random = np.random.default_rng(0)
    drawn = np.concatenate([fields(WIDTHS[0], random) for _ in range(20)])
    assert drawn.var() == pytest.approx(1.0, abs=0.05) and len(drawn) == 20 * MAPS


def test_intervals_are_those_of_clopper_and_pearson() -> None:
    """Without a hit the upper end u has (1 - u)^n = 2.5 %."""
    assert interval(0, 10) == (0.0, pytest.approx(1.0 - 0.025**0.1))
    assert interval(10, 10)[0] == pytest.approx(0.025**0.1)
    assert interval(5, 100, 0.001)[0] < interval(5, 100)[0] < 0.05 < interval(5, 100)[1]


@pytest.mark.slow
@pytest.mark.parametrize("design", DESIGNS)
def test_every_design_gives_p_values(design: str) -> None:
    found = levels_of(design, WIDTHS[0], 3)
    assert all(1.0 / 200 <= p <= 1.0 for p in found.values()) and found == levels_of(design, WIDTHS[0], 3)


def test_a_broken_level_has_two_stars_and_sets_that_are_done_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "p.jsonl"
    rows = [
        [f"{name}, {WIDTHS[0]:g}", seed, {"t": 0.01 if name == "pairs" else 0.5}] for name in DESIGNS for seed in (0, 1)
    ]
    file.write_text("".join(json.dumps(row) + "\n" for row in rows))
    before = file.read_text()
    monkeypatch.setattr(sys, "argv", ["levels", "level", str(file), "--sets", "2"])
    main()
    assert file.read_text() == before and capsys.readouterr().out.strip() == table_of(file)
    assert next(line for line in table_of(file).splitlines() if "**" in line).startswith(
        "| pairs, 0.5 | 2 | 100.0 (15.8"
    )
