"""Colours of vertices: read from OBJ and PLY, written so that viewers show them, drawn and denoised as one map."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.mesh.vertex_colours import COLOURS, as_bytes, as_shares, colour_of

BALL = sx.shape("icosphere", levels=2)
CODES = np.random.default_rng(0).integers(0, 256, (162, 3))
COLOURED = sx.Surface(BALL.mesh, scalars=dict(zip(COLOURS, CODES.T.astype(float), strict=True)))


def _uchar(path: Path) -> list[str]:
    head = path.read_bytes().split(b"end_header")[0].decode()
    return [line.split()[-1] for line in head.splitlines() if line.startswith("property uchar")]


@pytest.mark.optional
def test_colours_of_an_obj_are_maps_and_open_in_viewers_as_ply(working_folder: Path) -> None:
    painted = np.c_[CODES, np.full(162, 255)].astype(np.uint8)
    trimesh = pytest.importorskip("trimesh")
    trimesh.Trimesh(BALL.vertices, BALL.faces, vertex_colors=painted, process=False).export("ball.obj")
    read = sx.read("ball.obj")
    np.testing.assert_array_equal(colour_of(read.scalars, "color"), CODES)
    assert main(["convert", "ball.obj", "ball.ply"]) == 0
    again = trimesh.load("ball.ply", process=False)
    np.testing.assert_array_equal(np.asarray(again.visual.vertex_colors)[:, :3], CODES)


def test_colours_and_alpha_of_a_ply_stay_bytes(working_folder: Path) -> None:
    surface = sx.Surface(
        BALL.mesh, scalars={**COLOURED.scalars, "alpha": np.full(162, 255.0), "height": BALL.vertices[:, 2]}
    )
    sx.write("ball.ply", surface)
    assert _uchar(Path("ball.ply")) == ["red", "green", "blue", "alpha"]
    again = sx.read("ball.ply").scalars
    assert list(again) == list(surface.scalars)
    for name, values in surface.scalars.items():
        np.testing.assert_array_equal(again[name], values)
    sx.write("odd.ply", sx.Surface(BALL.mesh, scalars={**COLOURED.scalars, "blue": CODES[:, 2] + 0.5}))
    assert _uchar(Path("odd.ply")) == []
    np.testing.assert_array_equal(sx.read("odd.ply").scalars["blue"], CODES[:, 2] + 0.5)


def test_half_a_coloured_obj_says_that_colours_are_left_out(working_folder: Path) -> None:
    lines = ["v 0 0 0 1 0 0", "v 1 0 0 0 1 0", "v 0 1 0", "f 1 2 3"]
    Path("a.obj").write_text("\n".join(lines))
    read = sx.read("a.obj")
    assert not read.scalars and "2 of 3 vertices have a colour: colours are left out." in read.notes


def test_a_picture_of_bytes_is_that_of_shares() -> None:
    wanted = sx.plot(BALL, CODES / 255.0, width=200).figure.pixels
    for given in (CODES.astype(float), CODES):
        np.testing.assert_array_equal(sx.plot(BALL, given, width=200).figure.pixels, wanted)
    np.testing.assert_array_equal(sx.plot(COLOURED, "color", width=200).figure.pixels, wanted)


def test_the_colour_of_a_scan_is_denoised_as_one_map(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sx.write("scan.ply", COLOURED)
    assert main(["denoise", "scan.ply", "color", "--method", "rof", "--to", "clean.ply"]) == 0
    assert _uchar(Path("clean.ply")) == ["red", "green", "blue"]
    assert "clean.ply: colours are rounded to whole numbers from 0 to 255" in capsys.readouterr().err
    wanted = sx.denoise(COLOURED, CODES.astype(float), method="rof").values
    found = colour_of(sx.read("clean.ply").scalars, "rgb")
    np.testing.assert_array_equal(found, np.clip(np.rint(wanted), 0, 255))
    np.testing.assert_array_equal(sx.denoise(COLOURED, "colour", method="rof").values, wanted)


def test_a_surface_without_colours_has_no_colour() -> None:
    with pytest.raises(ValueError, match="has no map 'color'; it has none"):
        sx.denoise(BALL, "color")
    assert colour_of({"color": CODES[:, 0], **COLOURED.scalars}, "color") is None


def test_shares_and_bytes() -> None:
    np.testing.assert_array_equal(as_bytes(np.array([[0.0, 0.5019, 1.0]])), [[0.0, 128.0, 255.0]])
    np.testing.assert_array_equal(as_bytes(np.array([[0.0, 0.5, 1.0]])), [[0.0, 127.5, 255.0]])
    np.testing.assert_array_equal(as_bytes(np.array([[0.0, 7.0, 255.0]])), [[0.0, 7.0, 255.0]])
    np.testing.assert_array_equal(as_shares(np.array([[0.0, 1.02, np.nan]])), [[0.0, 1.02, np.nan]])
    np.testing.assert_array_equal(as_shares(np.array([[0.0, 51.0, 255.0]])), [[0.0, 0.2, 1.0]])
