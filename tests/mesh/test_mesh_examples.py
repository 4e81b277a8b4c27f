"""The mesh examples run and print what they should."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
EXPECTED = {
    "mesh_repair": ["1 non-manifold edges", "genus 0, 642 vertices, area error 0.0e+00"],
    "painted_cup": ["genus 1, minimum angle 3", "noise 40."],
    "gauss_bonnet": ["fsaverage5 white, left", "total curvature 4.000000 pi"],
}


@pytest.mark.parametrize("name", EXPECTED)
def test_example(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLES / f"{name}.py"))
    printed = capsys.readouterr().out
    for words in EXPECTED[name]:
        assert words in printed
