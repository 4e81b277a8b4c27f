"""Surfaces that people have: in pieces, of one name in two formats; sources that are no vertices."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.mesh.triangle_mesh import TriangleMesh

BALL = sx.shape("ellipsoid", levels=2)


def two_balls() -> sx.Surface:
    mesh, count = BALL.mesh, len(BALL.mesh.vertices)
    moved = mesh.vertices * [1.0, 1.1, 1.2] + [5.0, 0.0, 0.0]
    return sx.Surface(TriangleMesh(np.vstack([mesh.vertices, moved]), np.vstack([mesh.faces, mesh.faces + count])))


def test_two_files_of_one_name_are_two_columns(tmp_path: Path) -> None:
    for suffix in ("ply", "off"):
        sx.write(tmp_path / f"ball.{suffix}", BALL)
    sx.write(tmp_path / "other.ply", BALL)
    assert list(sx.fingerprint(tmp_path, count=2).columns) == ["ball.off", "ball.ply", "other"]


def test_the_maps_of_a_surface_go_where_there_is_room_for_them(tmp_path: Path) -> None:
    ball = sx.Surface(BALL.mesh, "ball", "mm", {"height": BALL.mesh.vertices[:, 2]})
    for suffix, expected in ((".ply", ["height"]), (".vtk", ["height"]), (".off", []), (".stl", [])):
        sx.write(tmp_path / f"ball{suffix}", ball)
        assert list(sx.read(tmp_path / f"ball{suffix}").scalars) == expected


@pytest.mark.parametrize(("sources", "named"), [(-3, "-3"), ([0, 2.5], "2.5"), (10**6, "1000000")])
def test_a_source_that_is_no_vertex_is_named(sources: object, named: str) -> None:
    with pytest.raises(
        ValueError, match=rf"sources (name vertex|has the value) {named}, (the vertices are 0\.\.|whole numbers)"
    ):
        sx.geodesic(BALL, sources)  # type: ignore[arg-type]


def test_a_skeleton_of_pieces_needs_a_map(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sx.write("two.ply", two_balls())
    assert main(["skeleton", "two.ply", "--to", "graph.vtk"]) == 2
    assert "2 pieces" in capsys.readouterr().err and not Path("graph.vtk").exists()
