"""The example of sulci prints the numbers that it promises."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def printed(name: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out.splitlines()


def test_sulcal_lines(capsys: pytest.CaptureFixture[str]) -> None:
    lengths, labels = printed("sulcal_lines", capsys)
    values = [int(part.split()[-2]) for part in lengths.split(", ")]
    assert values[0] < 0.85 * values[1] and 110 < values[1] < 160
    assert labels.startswith("lh.sulci.annot: ") and int(labels.split()[1]) > 15
