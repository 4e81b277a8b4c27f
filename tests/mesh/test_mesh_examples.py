"""The mesh examples run and print what they should."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "inside"
EXPECTED = {
    "painted_cup": ["genus 1, minimum angle 3", "noise 40."],
}


@pytest.mark.parametrize("name", EXPECTED)
def test_example(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLES / f"{name}.py"))
    printed = capsys.readouterr().out
    for words in EXPECTED[name]:
        assert words in printed
