"""The example of recognition prints the numbers that it promises."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def printed(name: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out.splitlines()


@pytest.mark.slow
def test_recognise_again(capsys: pytest.CaptureFixture[str]) -> None:
    first, second = printed("recognise_again", capsys)
    share, low = float(first.split()[0]), float(first.split()[6])
    assert 0.1 < low < share < 1.0 and first.endswith("median reliability 0.86")
    assert second.startswith("ARPACK differs by ") and float(second.split()[-1]) < 1e-8
