"""Every run and plan that the README shows can be planned as pasted."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

import surfexp as sx
from surfexp.commands.command_line import main

README = Path(__file__).resolve().parents[2] / "README.md"
STARTS = ("surfexp run ", "surfexp plan ")
# of a folder that `surfexp collect` wrote, of a plugin that the page shows, a search, a cluster: seen elsewhere
ELSEWHERE = ("axes", "scaled", "hydra/sweeper", "profile=")
LINES = [
    line.partition("  #")[0].strip()
    for line in README.read_text(encoding="utf-8").splitlines()
    if line.startswith(STARTS) and not any(word in line for word in ELSEWHERE)
]


@pytest.fixture
def files(working_folder: Path) -> None:
    ball = sx.shape("icosphere", levels=3)
    sx.write("brain.ply", ball)
    import nibabel

    nibabel.freesurfer.write_geometry("lh.white", ball.mesh.vertices, ball.mesh.faces)
    nibabel.freesurfer.write_morph_data("lh.curv", ball.mesh.vertices[:, 2])
    nibabel.freesurfer.write_morph_data("lh.sulc", ball.mesh.vertices[:, 0])
    Path("lh.cortex.label").write_text("#!ascii label\n2\n0 0 0 1 0\n1 0 0 1 0\n", encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("line", LINES)
def test_it_can_be_planned(line: str, files: None, capsys: pytest.CaptureFixture[str]) -> None:
    _, _, *arguments = shlex.split(line)
    assert main(["plan", *arguments]) == 0, capsys.readouterr().err
