"""The examples run and print what they claim."""

import re
import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "inside"

BOUNDS = {
    "why_the_operator_matters": [(10.0, 20.0), (24.0, 35.0)],
    "exact_minimiser": [(0.84, 0.85), (0.8475, 0.8475), (0.0, 1e-10)],
    "denoise_a_cube": [(20.0, 35.0), (0.0, 5.0)],
    "shrink_a_circle": [(4.58, 4.65), (4.626, 4.626)],
}


@pytest.mark.parametrize("name", BOUNDS)
def test_example(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(EXAMPLES / f"{name}.py"))
    printed = [float(number) for number in re.findall(r"\d+(?:\.\d+)?(?:e-\d+)?", capsys.readouterr().out)]
    assert len(printed) == len(BOUNDS[name])
    for number, (low, high) in zip(printed, BOUNDS[name], strict=True):
        assert low <= number <= high
