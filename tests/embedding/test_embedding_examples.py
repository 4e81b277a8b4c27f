"""The examples of the embedding print the numbers that they promise."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "inside"


def printed(name: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out.splitlines()


def test_broken_triangle(capsys: pytest.CaptureFixture[str]) -> None:
    mean, largest = (float(line.split()[-4]) for line in printed("broken_triangle", capsys))
    assert mean > 3.0 and largest <= 1.0


@pytest.mark.slow
def test_carry_labels(capsys: pytest.CaptureFixture[str]) -> None:
    assert float(printed("carry_labels", capsys)[0].split()[0]) > 91.0
