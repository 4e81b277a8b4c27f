"""The examples of the spectrum print the numbers that they promise."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "inside"


def printed(name: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out.splitlines()


def test_curved_elements(capsys: pytest.CaptureFixture[str]) -> None:
    errors = [float(line.split()[-1]) for line in printed("curved_elements", capsys)]
    assert errors == pytest.approx([8.1e-3, 5.0e-3, 1.3e-4, 2.2e-6], rel=0.05)


def test_heard_geometry(capsys: pytest.CaptureFixture[str]) -> None:
    words = printed("heard_geometry", capsys)[0].split()
    assert float(words[1]) == pytest.approx(39.478418, rel=1e-4)
    assert abs(float(words[-1])) < 0.02


def test_patches_on_a_bare_mesh(capsys: pytest.CaptureFixture[str]) -> None:
    errors = [float(line.split()[-1]) for line in printed("patches_on_a_bare_mesh", capsys)]
    assert errors == pytest.approx([4.8e-3, 3.0e-5], rel=0.05)
