"""LEFT+RIGHT in the place of a file: both hemispheres in every command on surfaces."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.commands.given_maps import both_of
from surfexp.io.map_files import read_maps
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface

BALL = sx.shape("icosphere", levels=2).mesh
HEIGHT = BALL.vertices[:, 2]
RANDOM = np.random.default_rng(0)
NOISY = {side: HEIGHT + 0.2 * RANDOM.standard_normal(162) for side in ("left", "right")}
PAIR, MAP = "lh.white.ply+rh.white.ply", "lh.z.mgh+rh.z.mgh"


@pytest.fixture
def folder(working_folder: Path) -> Path:
    for letter, side in (("l", "left"), ("r", "right")):
        sx.write(f"{letter}h.white.ply", Surface(BALL, hemisphere=side))
        sx.write(f"{letter}h.z.mgh", NOISY[side].astype(np.float32))
        sx.write(f"{letter}h.cortex.csv", (HEIGHT > -0.8).astype(float))
        sx.write(f"{letter}h.parts.annot", LabelMap((HEIGHT > 0).astype(int), {0: "south+x", 1: "north"}))
        data = RANDOM.standard_normal((162, 7)) + 4.0 * (HEIGHT > 0.6)[:, None] * (side == "right")
        sx.write(f"{letter}h.all.npy", data)
    return working_folder


def brain() -> sx.Surface:
    pair = {"left": "lh.white.ply", "right": "rh.white.ply"}
    return sx.read(**pair, maps={"z": {"left": "lh.z.mgh", "right": "rh.z.mgh"}})


def test_smooth_and_denoise_write_one_file_or_two(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wanted = sx.smooth(brain(), "z", 0.5).values
    assert main(["smooth", PAIR, MAP, "--width", "0.5", "--to", "smooth.mgh"]) == 0
    assert "lh.smooth.mgh and rh.smooth.mgh: " in capsys.readouterr().out
    found = [read_maps(f"{letter}h.smooth.mgh")[f"{letter}h.smooth"] for letter in "lr"]
    np.testing.assert_allclose(np.concatenate(found), wanted, rtol=1e-5, atol=1e-6)
    assert set(json.loads(Path("smooth.mgh.json").read_text())["inputs"]) == {*PAIR.split("+"), *MAP.split("+")}
    assert main(["denoise", PAIR, "z", "--map", f"z={MAP}", "--method", "rof", "--to", "clean.dscalar.nii"]) == 0
    clean = sx.denoise(brain(), "z", method="rof").values
    found = [read_maps("clean.dscalar.nii", side)["z"] for side in ("left", "right")]
    np.testing.assert_allclose(np.concatenate(found), clean, rtol=1e-5, atol=1e-6)
    assert main(["smooth", PAIR, "clean.dscalar.nii", "--width", "0.5", "--to", "again.npz"]) == 0


def test_modes_nulls_and_pictures_of_both(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["modes", PAIR, "-k", "6", "--mask", "lh.cortex.csv+rh.cortex.csv", "--to", "modes.npz"]) == 0
    with np.load("modes.npz") as found:
        assert (found["values"][:2] < 1e-9).all() and found["vectors"].shape == (324, 6)
    assert main(["nulls", PAIR, MAP, MAP, "--count", "19", "--modes", "16"]) == 0
    assert "r = 1.000" in (said := capsys.readouterr().out) and "drawn apart" in said
    assert main(["plot", PAIR, MAP, "--borders", "lh.parts.annot+rh.parts.annot", "--to", "z.png"]) == 0
    assert main(["segment", PAIR, MAP, "--to", "parts.label.gii"]) == 0 and Path("rh.parts.label.gii").is_file()
    assert main(["convert", PAIR, "copy.surf.gii"]) == 0 and Path("lh.copy.surf.gii").is_file()
    assert "lh.copy.surf.gii and rh.copy.surf.gii: 324 vertices" in capsys.readouterr().out


def test_a_test_of_groups_on_both(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    labels = ["--labels", "lh.parts.annot+rh.parts.annot", "--table", "clusters.csv"]
    assert main(["test", PAIR, "lh.all.npy+rh.all.npy", *labels, "--to", "t.func.gii"]) == 0
    assert "right hemisphere" in capsys.readouterr().out
    assert Path("clusters.csv").read_text().startswith("hemisphere,vertices") and Path("lh.t.func.gii").is_file()


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["rh.white.ply+lh.white.ply", MAP], "surface rh.white.ply is given as left, it is of the other hemisphere"),
        ([PAIR, "rh.z.mgh+lh.z.mgh"], "map rh.z.mgh is given as left"),
        ([PAIR, "lh.z.mgh"], "is one file, the surface is both hemispheres: write LEFT+RIGHT"),
        ([PAIR, "lh.z.mgh+rh.none.mgh"], "rh.none.mgh cannot be read"),
        ([PAIR, MAP, "--hemisphere", "left"], "names one side"),
        ([PAIR, MAP, "--mask", "lh.cortex.csv"], "for two hemispheres"),
        (["lh.white.ply+rh.none.ply", MAP], "rh.none.ply cannot be read"),
    ],
)
def test_mistakes_are_told_in_one_line(
    folder: Path, arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["smooth", *arguments, "--width", "0.5", "--to", "smooth.npz"]) == 2
    said = capsys.readouterr().err.strip()
    assert line in said and len(said.splitlines()) == 1


@pytest.mark.parametrize("command", ["distance", "align"])
def test_what_needs_one_hemisphere_names_the_files_to_give(
    folder: Path, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([command, "lh.white.ply", PAIR, "--to", "compared.npz"]) == 2
    said = capsys.readouterr().err.strip()
    assert said.endswith(f"{PAIR} is both hemispheres, one is needed: give lh.white.ply or rh.white.ply")


def test_inputs_are_not_overwritten_by_either_side(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = Path("rh.z.mgh").read_bytes()
    assert main(["smooth", PAIR, MAP, "--width", "0.5", "--to", "z.mgh"]) == 2
    assert "would overwrite" in capsys.readouterr().err and Path("rh.z.mgh").read_bytes() == before
    assert main(["smooth", PAIR, MAP, "--width", "0.5", "--to", "lh.smooth.mgh"]) == 2
    assert "named as the left hemisphere" in capsys.readouterr().err


def test_a_plus_in_a_name_is_part_of_it(folder: Path) -> None:
    assert both_of("map") == "map"
    Path("a+b.csv").touch()
    assert both_of("a+b.csv") == "a+b.csv"
    assert both_of("a+b.csv+lh.z.mgh") == {"left": "a+b.csv", "right": "lh.z.mgh"}
    names = {"left": "lh.parts.annot:south+x", "right": "rh.parts.annot:north"}
    assert both_of("+".join(names.values())) == names
    assert main(["modes", PAIR, "-k", "3", "--mask", "+".join(names.values()), "--to", "modes.npz"]) == 0
