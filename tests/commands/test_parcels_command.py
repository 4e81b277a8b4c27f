"""`surfexp parcels`: the table and the map of the function, from files."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.io.map_files import read_maps
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface

BALL = sx.shape("icosphere", levels=3).mesh
HEIGHT = BALL.vertices[:, 2]


@pytest.fixture
def folder(working_folder: Path) -> Path:
    for letter, side in (("l", "left"), ("r", "right")):
        surface = Surface(BALL, hemisphere=side)
        sx.write(f"{letter}h.white.ply", surface)
        sx.write(f"{letter}h.z.npy", HEIGHT)
        sx.write(f"{letter}h.parts.annot", LabelMap((HEIGHT > 0).astype(int), {0: "south", 1: "north"}))
    return working_folder


def rows(file: str) -> list[dict[str, str]]:
    with Path(file).open() as stream:
        return list(csv.DictReader(stream))


def test_the_table_and_the_map_are_those_of_the_function(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["parcels", "lh.white.ply", "lh.z.npy", "lh.parts.annot", "--to", "z.csv", "--means", "means.npy"]
    assert main(call) == 0 and "z.csv: 2 parcels of area" in capsys.readouterr().out
    wanted = sx.parcels("lh.white.ply", HEIGHT, LabelMap((HEIGHT > 0).astype(int), {0: "south", 1: "north"}))
    found = rows("z.csv")
    assert [row["parcel"] for row in found] == ["south", "north"] and found[0]["hemisphere"] == "left"
    for name, numbers in (("mean", wanted.means), ("median", wanted.medians), ("area", wanted.areas)):
        assert [float(row[name]) for row in found] == numbers.tolist()
    np.testing.assert_array_equal(np.load("means.npy"), wanted.values)
    assert set(json.loads(Path("z.csv.json").read_text())["inputs"]) == {"lh.white.ply", "lh.z.npy", "lh.parts.annot"}


def test_both_hemispheres_stand_in_one_table(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["parcels", "lh.white.ply+rh.white.ply", "lh.z.npy+rh.z.npy", "lh.parts.annot+rh.parts.annot"]
    assert main([*call, "--to", "z.csv", "--means", "means.mgh"]) == 0
    assert "lh.means.mgh and rh.means.mgh: the mean of each parcel" in capsys.readouterr().out
    assert main([*call, "--to", "z.csv", "--means", "means.dscalar.nii"]) == 0
    assert [row["hemisphere"] for row in rows("z.csv")] == ["left", "left", "right", "right"]
    assert len(read_maps("means.dscalar.nii", "right")["mean"]) == len(HEIGHT)


def test_maps_of_one_file_keep_their_names(folder: Path) -> None:
    np.savez("both.npz", thickness=HEIGHT, sulc=2.0 * HEIGHT)
    call = ["parcels", "lh.white.ply", "both.npz", "lh.parts.annot", "--to", "z.csv"]
    assert main([*call, "--means", "means.npz"]) == 0
    (south, north) = rows("z.csv")
    assert float(north["mean sulc"]) == 2.0 * float(north["mean thickness"]) > 0.0 and "median thickness" in south
    assert [*read_maps("means.npz")] == ["mean thickness", "mean sulc"]
    assert main([*call, "--means", "means.ply"]) == 0
    assert [*sx.read("means.ply").scalars] == ["mean_thickness", "mean_sulc"]
    # a format without names holds them in their order
    assert main([*call, "--means", "means.npy"]) == 0
    np.testing.assert_array_equal(np.load("means.npy")[:, 1], read_maps("means.npz")["mean sulc"])


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["lh.z.npy", "--to", "z.csv"], "is no file of labels"),
        (["lh.parts.annot", "--to", "z.xls"], "choose .csv"),
        (["lh.parts.annot", "--to", "lh.z.npy"], "choose .csv"),
        (["rh.parts.annot", "--to", "z.csv"], "is of the right hemisphere"),
        (["lh.parts.annot", "--to", "z.csv", "--means", "rh.z.npy"], "named as the right hemisphere"),
        (["lh.parts.annot", "--to", "z.csv", "--means", "./z.csv"], "z.csv is the file of two results"),
    ],
)
def test_mistakes_are_told_in_one_line(
    folder: Path, arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["parcels", "lh.white.ply", "lh.z.npy", *arguments]) == 2
    said = capsys.readouterr().err.strip()
    assert line in said and len(said.splitlines()) == 1 and not Path("z.csv").exists()
