"""`surfexp nulls`: a correlation in the terminal, null maps in a file, as the functions give them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main

BALL = sx.shape("icosphere", levels=3)
X, Y, Z = BALL.mesh.vertices.T
SHORT = ["--count", "39", "--modes", "36", "--seed", "2"]


@pytest.fixture
def folder(working_folder: Path) -> Path:
    sx.write("ball.vtp", {"height": Z * X}, BALL)
    sx.write("other.npy", Y + 0.5 * Z * X)
    return working_folder


def test_a_correlation_is_printed_with_p_interval_and_reason(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["nulls", "ball.vtp", "height", "other.npy", *SHORT]) == 0
    found = sx.compare_maps(BALL, Z * X, Y + 0.5 * Z * X, count=39, modes=36, seed=2)
    low, high = found.interval
    said = capsys.readouterr().out.splitlines()
    assert said[0] == f"r = {found.r:.3f}, 95 % interval {low:.3f} to {high:.3f}, p = {found.p:.3g} by 39 null maps"
    assert said[1] == found.reason and said[1].startswith("Eigenstrapping: 36 modes hold 100%")


def test_null_maps_are_written_with_their_certificate(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["nulls", "ball.vtp", "height", "other.npy", *SHORT, "--to", "both.npz"]) == 0
    assert main(["nulls", "ball.vtp", "height", *SHORT, "--method", "variogram", "--to", "one.npz"]) == 0
    wanted = sx.null_maps(BALL, Z * X, 39, modes=36, seed=2).values
    with np.load("both.npz") as both, np.load("one.npz") as one:
        np.testing.assert_allclose(both["null"], wanted, atol=1e-9)
        assert one["null"].shape == wanted.shape
    certificate = json.loads(Path("both.npz.json").read_text())
    assert certificate["method"] == "eigenstrapping" and certificate["options"]["seed"] == 2
    assert {"r", "p", "low", "high", "share_in_modes"} <= set(certificate) and "other.npy" in certificate["inputs"]
    assert json.loads(Path("one.npz.json").read_text())["method"] == "variogram"
    assert "Variograms were asked for." in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["height"], "nothing to do: give OTHER to compare with, or --to FILE"),
        (["height", "none.npy"], "none.npy is no file"),
        (["height", "other.npy", "--count", "0"], "count = 0"),
        (["height", "--to", "nulls.shape.gii.x"], "unknown format"),
    ],
)
def test_mistakes_are_told_in_one_line(
    folder: Path, arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["nulls", "ball.vtp", *arguments]) == 2
    said = capsys.readouterr().err.strip()
    assert line in said and len(said.splitlines()) == 1
