"""`surfexp reeb-distance`: bounds as the library gives them, and the space that proves the upper one in a file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.skeleton.common_space import CommonSpace, common_space_defects
from surfexp.tasks import reeb_distances

TORUS = sx.shape("torus", n_u=24, n_v=12)
HEIGHT = TORUS.mesh.vertices[:, 0]


@pytest.fixture
def folder(working_folder: Path) -> Path:
    sx.write("torus.ply", TORUS)
    sx.write("ball.ply", sx.shape("icosphere", levels=2))
    sx.write("noisy.npy", HEIGHT + 0.1 * np.random.default_rng(0).standard_normal(len(HEIGHT)))
    sx.write("own.vtp", {"height": HEIGHT}, TORUS)
    return working_folder


def test_the_distance_of_two_surfaces_by_a_coordinate(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    surfaces = sx.read("torus.ply"), sx.read("ball.ply")
    # z is the height where no map is named
    for axis, arguments in enumerate((["--map", "x"], ["--map", "y"], [])):
        graphs = [sx.reeb_graph(one, one.mesh.vertices[:, axis], count=20) for one in surfaces]
        assert main(["reeb-distance", "torus.ply", "ball.ply", "--count", "20", *arguments]) == 0
        assert capsys.readouterr().out == f"distance {sx.reeb_distance(*graphs).upper:.6g} (proved)\n"


def test_the_space_in_the_file_proves_the_bound_of_the_certificate(folder: Path) -> None:
    call = ["reeb-distance", "own.vtp", "torus.ply", "--map", "height", "--second-map", "noisy.npy"]
    assert main([*call, "--count", "12", "--effort", "20000", "--to", "space.npz"]) in (0, 3)
    said = json.loads(Path("space.npz.json").read_text())
    assert said["checked"] is True and 0 < said["by_persistence"] <= said["lower"] <= said["upper"]
    assert set(said["inputs"]) == {"own.vtp", "torus.ply", "noisy.npy"}
    assert said["options"]["map"] == "height" and said["options"]["second_map"] == "noisy.npy"
    own, other = sx.read("own.vtp"), sx.read("torus.ply")
    first, second = sx.reeb_graph(own, "height", count=12), sx.reeb_graph(other, np.load("noisy.npy"), count=12)
    space = CommonSpace(**np.load("space.npz"))
    assert space.arcs.dtype == np.int64 and space.triangles.shape[1] == 3
    graphs = (first.values, first.arcs), (second.values, second.arcs)
    assert common_space_defects(space, *graphs, said["upper"]) == ()
    assert common_space_defects(space, *graphs[::-1], said["upper"])


def test_branches_may_be_removed_first(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["reeb-distance", "torus.ply", "torus.ply", "--map", "noisy.npy", "--second-map", "x"]
    assert main([*call, "--persistence", "0.4"]) == 0
    pruned = float(capsys.readouterr().out.split()[1])
    noisy = sx.reeb_graph("torus.ply", np.load("noisy.npy"), persistence=0.4)
    plain = sx.reeb_graph("torus.ply", sx.read("torus.ply").mesh.vertices[:, 0], persistence=0.4)
    assert pruned == pytest.approx(sx.reeb_distance(noisy, plain).upper, rel=1e-5)


def test_a_search_that_was_cut_short_ends_with_3_and_is_kept(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["reeb-distance", "torus.ply", "torus.ply", "--map", "x", "--second-map", "noisy.npy", "--effort", "1"]
    assert main(call) == 3
    said = capsys.readouterr()
    assert "not proved" in said.out and "cut short" in said.err
    assert main([*call, "--to", "space.npz"]) == 3 and Path("space.npz").exists()
    assert json.loads(Path("space.npz.json").read_text())["complete"] is False


def test_a_space_that_proves_nothing_is_said(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reeb_distances, "common_space_defects", lambda *_: ("it has 2 pieces",))
    assert main(["reeb-distance", "torus.ply", "ball.ply", "--map", "x", "--to", "space.npz"]) == 3
    said = json.loads(Path("space.npz.json").read_text())
    assert said["checked"] is False and said["notes"] == ["it has 2 pieces"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["torus.ply", "ball.ply", "--map", "noisy.npy"], "map has shape"),
        (["torus.ply", "ball.ply", "--map", "w"], "w cannot be read"),
        (["torus.ply", "nosuch.ply"], "nosuch.ply"),
        (["torus.ply", "ball.ply", "--effort", "0"], "effort = 0"),
        (["torus.ply", "ball.ply", "--to", "space.csv"], "choose .npz"),
    ],
)
def test_mistakes_are_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    assert main(["reeb-distance", *arguments]) == 2
    said = capsys.readouterr()
    assert message in said.err and said.err.count("\n") == 1 and said.out == ""
