"""The examples on skeletons of patches run and print what they claim."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def numbers(name, capsys):
    runpy.run_path(str(EXAMPLES / f"{name}.py"))
    return [float(number) for number in re.findall(r"[\d.]*\d", capsys.readouterr().out)]


def test_callosum_skeleton(capsys):
    uniform, even = numbers("callosum_skeleton", capsys)
    assert even < 1.0 < 10.0 < uniform


def test_flux_weights(capsys):
    one, low, high, first, quarter, lower, higher, second = numbers("flux_weights", capsys)
    assert (one, quarter) == (1, 0.25) and 1 / np.e < lower < low < 1 < high < higher < np.e
    assert 0 < first < second < np.e * first


def test_hamilton_jacobi(capsys):
    ends, forks, loops, chain_ends, *none = numbers("hamilton_jacobi", capsys)
    assert ends > 2 and forks >= 1 and loops == 0 and chain_ends == 2 and none == [0, 0]


@pytest.mark.slow
def test_level_set_parametrization(capsys):
    u, v, found_u, found_v, points, total, p = numbers("level_set_parametrization", capsys)
    assert abs(found_u - u) < 0.08 and abs(found_v - v) < 0.15 and 0 < points < 0.15 * total and p <= 0.02
