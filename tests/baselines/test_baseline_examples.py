"""The baseline examples run and print what they claim."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "inside"


def numbers(name, pattern, capsys):
    runpy.run_path(str(EXAMPLES / f"{name}.py"))
    return [tuple(map(float, found.groups())) for found in re.finditer(pattern, capsys.readouterr().out)]


def test_level_set_baseline(capsys):
    excesses = [excess for (excess,) in numbers("level_set_baseline", r"excess ([\d.]+)", capsys)]
    assert len(excesses) == 3 and excesses == sorted(excesses, reverse=True) and excesses[-1] < 0.06


def test_conformal_map(capsys):
    found = numbers("conformal_map", r"error ([\d.]+) degrees, (\d+)", capsys)
    assert [flips for _, flips in found] == [0, 0, 0]
    assert found[0][0] > 1.9 * found[1][0] > 3.6 * found[2][0] > 0


def test_patchwise_seams(capsys):
    ((seams, elsewhere),) = numbers("patchwise_seams", r"difference ([\d.]+) on the seams, ([\d.]+) elsewhere", capsys)
    assert seams > 2 * elsewhere > 0
