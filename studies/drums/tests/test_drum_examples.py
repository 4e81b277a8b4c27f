"""The examples of drums print the numbers that they promise."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def printed(name: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    return capsys.readouterr().out.splitlines()


def test_isospectral_drums(capsys: pytest.CaptureFixture[str]) -> None:
    first, second = (line.split(" nodal domains ") for line in printed("isospectral_drums", capsys))
    assert first[0] == second[0]
    assert (first[1], second[1]) == ("1 2 3 3 4", "1 2 3 4 4")


@pytest.mark.slow
def test_drum_values(capsys: pytest.CaptureFixture[str]) -> None:
    values, extrapolated, finest = printed("drum_values", capsys)
    assert float(values.split()[0]) == pytest.approx(2.5379439998, abs=2e-7)
    assert float(extrapolated.split()[-1]) < 0.1 * float(finest.split()[-1])


def test_transplanted_drum(capsys: pytest.CaptureFixture[str]) -> None:
    assert printed("transplanted_drum", capsys) == ["pieces fit: True, still modes: True"]
