"""The examples run and print what they claim."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "inside"


def test_level_set_length(capsys: pytest.CaptureFixture[str]) -> None:
    order = runpy.run_path(str(EXAMPLES / "level_set_length.py"))["order"]
    assert order == pytest.approx(2.0, abs=0.2)
    assert f"order {order:.2f}" in capsys.readouterr().out


def test_surface_figure(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLES / "surface_figure.py"))
    # 1200 pixels wide, and light enough for a page
    assert capsys.readouterr().out.startswith("(576, 1200, 3) 1.1 % of the values")
    assert 50_000 < (working_folder / "surface_figure.png").stat().st_size < 350_000
