"""What a picture makes of the maps of a file: rows by name, columns of a series, and what shares a colour bar."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.mesh.surface import Surface
from surfexp.tasks.given_map import as_map
from surfexp.tasks.map_rows import rows_of_maps
from surfexp.tasks.shown import shown_surfaces

RNG = np.random.default_rng(0)


@pytest.fixture
def ball() -> Surface:
    return sx.shape("icosphere", levels=2)


@pytest.fixture
def brain(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Surface:
    """Two balls as both hemispheres, read from files of the working folder."""
    monkeypatch.chdir(tmp_path)
    mesh = sx.shape("icosphere", levels=2).mesh
    for letter, side in (("l", "left"), ("r", "right")):
        half = Surface(
            (mesh.vertices + np.array([-2.0 if side == "left" else 2.0, 0.0, 0.0]), mesh.faces), hemisphere=side
        )
        sx.write(f"{letter}h.white", half)
        sx.write(f"{letter}h.depth.mgh", RNG.normal(size=162))
    return sx.read(left="lh.white", right="rh.white")


def test_maps_of_a_file_are_rows_by_their_own_names(ball: Surface, tmp_path: Path) -> None:
    p = np.r_[0.01, np.ones(161)]
    np.savez(tmp_path / "test.npz", t=RNG.normal(size=162), p_t=p, p_tfce=p[::-1])
    rows = shown_surfaces(ball, tmp_path / "test.npz")
    assert [row[0].title for row in rows] == ["t", "p_t", "p_tfce"]
    scales = [row[0].scale for row in rows]
    assert scales[0].label == "t" and scales[0].limits is None
    # what lies between 0 and 1 has one colour bar
    assert scales[1] == scales[2] and scales[1].label == "p_t, p_tfce" and scales[1].limits == (0.0, 1.0)


def test_maps_whose_names_differ_by_numbers_alone_are_columns(ball: Surface, tmp_path: Path) -> None:
    np.savez(tmp_path / "rest.npz", **{f"frame {k}": RNG.normal(size=162) for k in range(3)})
    rows = shown_surfaces(ball, tmp_path / "rest.npz")
    assert [row[0].title for row in rows] == [f"column {k} of 3" for k in (1, 2, 3)]
    assert len({row[0].scale for row in rows}) == 1


def test_commands_name_the_maps_of_a_file(ball: Surface, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    sx.write("ball.ply", ball)
    np.savez("test.npz", t=RNG.normal(size=162), tfce=RNG.normal(size=162))
    assert main(["plot", "ball.ply", "test.npz", "--to", "test.svg"]) == 0
    drawn = Path("test.svg").read_text()
    assert "tfce" in drawn and "column" not in drawn


def test_a_pair_is_one_map_of_both_hemispheres(brain: Surface) -> None:
    files = {"left": "lh.depth.mgh", "right": "rh.depth.mgh"}
    arrays = {side: as_map(half, files[side]) for side, half in brain.hemispheres().items()}
    for given in (files, arrays):
        (row,) = shown_surfaces(brain, given)
        assert [view.title for view in row] == [f"{side}, {view}" for side in arrays for view in ("lateral", "medial")]
        np.testing.assert_array_equal(row[0].values, arrays["left"])
        np.testing.assert_array_equal(row[2].values, arrays["right"])
    assert rows_of_maps(files, [brain])[0].bar == "depth"


def test_both_hemispheres_share_the_colours_of_a_map_that_is_nearly_constant(brain: Surface) -> None:
    p = np.ones(324)
    p[3] = 0.01
    (row,) = shown_surfaces(brain, p)
    assert {view.scale.limits for view in row} == {(0.01, 1.0)}
    (row,) = shown_surfaces(brain, np.ones(324))
    assert {view.scale.limits for view in row} == {None}


@pytest.mark.parametrize("form", ["paths", "texts", "pairs", "lists", "surfaces", "meshes"])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_several_surfaces_are_told_from_vertices_and_faces(
    ball: Surface, working_folder: Path, form: str, count: int
) -> None:
    sx.write("ball.ply", ball)
    one = {
        "paths": Path("ball.ply"),
        "texts": "ball.ply",
        "pairs": (ball.vertices, ball.faces),
        "lists": [ball.vertices.tolist(), ball.faces.tolist()],
        "surfaces": ball,
        "meshes": ball.mesh,
    }[form]
    rows = shown_surfaces([one] * count)
    assert [len(row) for row in rows] == [count]
    assert all(len(view.mesh.faces) == len(ball.faces) for view in rows[0])
    assert len(shown_surfaces(one)[0]) == 1
