"""`surfexp check`, `surfexp repair` and `surfexp --version`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

BODY = sx.shape("icosphere", levels=2)


@pytest.fixture
def files(working_folder: Path) -> Path:
    turned = BODY.mesh.faces.copy()
    turned[:3] = turned[:3, ::-1]
    sx.write("good.ply", BODY)
    height = {"height": BODY.mesh.vertices[:, 2]}
    sx.write("bad.ply", Surface(TriangleMesh(BODY.mesh.vertices, turned), scalars=height))
    return working_folder


def test_defects_are_named_and_decide_the_exit_code(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "good.ply"]) == 0
    assert main(["check", "good.ply", "bad.ply", "nosuch.ply"]) == 2
    said = capsys.readouterr().out
    assert "no defect" in said and "3 flipped faces" in said and "nosuch.ply" in said


def test_what_is_repaired_is_sound_and_keeps_its_maps(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["repair", "bad.ply", "--to", "sound.ply"]) == 0
    assert "repaired: turned over" in capsys.readouterr().out
    assert main(["check", "sound.ply"]) == 0
    sound = sx.read("sound.ply")
    assert sound.scalars["height"] == pytest.approx(sound.mesh.vertices[:, 2])
    assert json.loads(Path("sound.ply.json").read_text())["changes"] == 1
    assert main(["repair", "good.ply", "--to", "same.ply"]) == 0
    assert "nothing to repair" in capsys.readouterr().out


def test_the_version_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.strip() == f"surfexp {sx.__version__}"
