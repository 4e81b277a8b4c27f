"""The examples on skeletons run and print what they claim."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "inside"


def numbers(name, capsys):
    runpy.run_path(str(EXAMPLES / f"{name}.py"))
    return [float(number) for number in re.findall(r"[\d.]*\d", capsys.readouterr().out)]


def test_reeb_graph(capsys):
    assert numbers("reeb_graph", capsys) == [2, 2, 6]


def test_boundary_distance(capsys):
    pytest.importorskip("pygeodesic")
    pytest.importorskip("potpourri3d")
    exact, marching, heat = numbers("boundary_distance", capsys)
    assert exact <= marching < 0.05 < heat < 0.6
