"""`surfexp plot` and `surfexp view`: what the functions take, from the command line."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np
import pytest
from click.testing import CliRunner

import surfexp as sx
from surfexp.commands.surface_commands import plot
from surfexp.commands.view import view
from surfexp.mesh.label_map import LabelMap


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


@pytest.mark.parametrize("name", ["lh.parts.annot", "parts.label.gii"])
@pytest.mark.parametrize("command", [plot, view])
def test_labels_of_a_file_are_drawn(folder: Path, command: click.Command, name: str) -> None:
    height = np.loadtxt("height.txt")
    sx.write("lh.ball", sx.Surface(sx.read("ball.ply").mesh, hemisphere="left"))
    sx.write(name, LabelMap((height > 0).astype(int), {0: "lower half", 1: "upper half"}))
    target = "a.svg" if command is plot else "a.html"
    made = CliRunner().invoke(command, ["lh.ball", name, "--to", target], catch_exceptions=False)
    assert made.exit_code == 0 and "upper half" in Path(target).read_text()
    plain, outlined = (
        Path(target).read_bytes()
        for options in ([], ["--borders", name])
        if not CliRunner().invoke(command, ["lh.ball", "height.txt", *options, "--to", target]).exit_code
    )
    assert plain != outlined


@pytest.mark.parametrize("option", [["rh.parts.annot"], ["height.txt", "--borders", "rh.parts.annot"]])
def test_labels_of_the_other_side_are_not_drawn(folder: Path, option: list[str]) -> None:
    sx.write("lh.ball", sx.Surface(sx.read("ball.ply").mesh, hemisphere="left"))
    sx.write("rh.parts.annot", LabelMap(np.zeros(642, dtype=int), {0: "all"}))
    made = CliRunner().invoke(plot, ["lh.ball", *option, "--to", "a.png"])
    assert made.exit_code and "right hemisphere" in str(made.exception)
    assert not Path("a.png").exists()
