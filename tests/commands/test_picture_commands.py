"""`surfexp plot` and `surfexp view`: what the functions take, from the command line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import surfexp as sx
from surfexp.commands.surface_commands import plot
from surfexp.commands.view import view


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    ball = sx.shape("icosphere", levels=3)
    sx.write("ball.ply", ball)
    np.savetxt("height.txt", ball.mesh.vertices[:, 2])
    return tmp_path


@pytest.mark.parametrize("suffix", ["png", "svg", "pdf"])
def test_plot_takes_views_colours_limits_and_lines(folder: Path, suffix: str) -> None:
    options = "--views top,front --colormap magma --limits -0.5 0.5 --contours 0 --contours 0.2 --width 400"
    made = CliRunner().invoke(plot, f"ball.ply height.txt {options} --to a.{suffix}".split(), catch_exceptions=False)
    assert made.exit_code == 0 and (folder / f"a.{suffix}").stat().st_size > 3000


def test_view_writes_one_page_with_the_limits_given(folder: Path) -> None:
    words = [
        "ball.ply",
        "height.txt",
        "--limits",
        "-0.5",
        "0.5",
        "--label",
        "depth",
        "--title",
        "Ball",
        "--to",
        "a.html",
    ]
    made = CliRunner().invoke(view, words, catch_exceptions=False)
    page = (folder / "a.html").read_text()
    assert made.exit_code == 0 and '"limits": [-0.5, 0.5]' in page and "<h1>Ball</h1>" in page and '"depth"' in page


def test_an_unknown_view_is_told_in_one_line(folder: Path) -> None:
    made = CliRunner().invoke(view, ["ball.ply", "--views", "tpo", "--to", "a.html"])
    assert made.exit_code and "top" in str(made.exception) and "\n" not in str(made.exception)
