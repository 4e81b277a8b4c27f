"""`surfexp skeleton`: what it writes, and what it says of what a graph cannot show."""

from __future__ import annotations

import inspect
import json
from pathlib import Path
from typing import get_args

import networkx
import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.commands.skeleton import LEVELS
from surfexp.skeleton.level_selection import Choice


@pytest.fixture
def folder(working_folder: Path) -> Path:
    torus = sx.shape("torus", n_u=40, n_v=20)
    sx.write("torus.ply", torus)
    sx.write("x.npy", torus.vertices[:, 0])
    sx.write("upper.npy", np.where(torus.vertices[:, 1] > -0.2, torus.vertices[:, 0], np.nan))
    return working_folder


def test_a_ring_between_two_levels_is_said_and_is_no_tree(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["skeleton", "torus.ply", "x.npy", "--count", "2"]
    assert main([*call, "--to", "ring.swc"]) == 2
    assert "the skeleton has loops (1, 1 of them between two levels), an SWC file holds" in capsys.readouterr().err
    assert not Path("ring.swc").exists()
    assert main([*call, "--to", "ring.graphml"]) == 0
    said, kept = capsys.readouterr(), json.loads(Path("ring.graphml.json").read_text())
    assert "loops 0, hidden_loops 1" in said.out and "1 of 1 handles have no level" in said.err
    assert kept["loops"] == 0 and kept["hidden_loops"] == 1 and "critical levels" in kept["notes"][0]
    assert main([*call[:3], "--count", "6", "--levels", "critical", "--to", "ring.graphml"]) == 0
    assert "loops 1, hidden_loops 0" in capsys.readouterr().out
    graph = networkx.read_graphml("ring.graphml")
    assert graph.number_of_edges() - graph.number_of_nodes() + 1 == 1


def test_the_choices_of_levels_are_those_of_the_library() -> None:
    assert (
        set(get_args(Choice)) == set(LEVELS)
        and inspect.signature(sx.reeb_graph).parameters["levels"].default == LEVELS[0]
    )


def test_the_part_that_was_taken_is_said(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for call in (
        ["skeleton", "torus.ply", "upper.npy", "--to", "part.vtk"],
        ["reeb-distance", "torus.ply", "torus.ply", "--map", "upper.npy", "--count", "5", "--to", "part.npz"],
    ):
        assert main(call) in (0, 3)
        assert "these are the mask" in capsys.readouterr().err
        assert any("these are the mask" in note for note in json.loads(Path(f"{call[-1]}.json").read_text())["notes"])


@pytest.mark.parametrize("pieces", [2, 3, 4])
def test_pieces_share_no_eigenfunction(working_folder: Path, capsys: pytest.CaptureFixture[str], pieces: int) -> None:
    one = sx.shape("ellipsoid", levels=2)
    count = len(one.vertices)
    vertices = np.concatenate([one.vertices + 9.0 * k for k in range(pieces)])
    sx.write("many.ply", (vertices, np.concatenate([one.faces + count * k for k in range(pieces)])))
    assert main(["skeleton", "many.ply", "--to", "many.vtk"]) == 2
    assert f"the surface has {pieces} pieces inside its mask" in capsys.readouterr().err


def test_an_eigenfunction_that_the_mesh_decides_is_said(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sx.write("ball.ply", sx.shape("icosphere", levels=2))
    sx.write("long.ply", sx.shape("ellipsoid", levels=2, semiaxes=(1.0, 1.2, 3.0)))
    assert main(["skeleton", "ball.ply", "--to", "ball.vtk"]) == 0
    assert "nearly double" in capsys.readouterr().err
    assert main(["skeleton", "long.ply", "--to", "long.vtk"]) == 0
    assert "nearly double" not in capsys.readouterr().err
