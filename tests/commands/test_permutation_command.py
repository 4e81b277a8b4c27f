"""`surfexp test`: files and a table of subjects in, maps and a table of clusters out, as the function gives them."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.io.map_files import read_maps
from surfexp.io.subject_table import read_subjects, rows_of_maps
from surfexp.mesh.label_map import LabelMap

BALL = sx.shape("icosphere", levels=2)
HEIGHT = BALL.mesh.vertices[:, 2]
SEX = ["f", "f", "m", "m", "f", "m", "m", "f"]
AGE = [23.0, 35.0, 41.0, 52.0, 60.0, 33.0, 47.0, 29.0]
DATA = np.random.default_rng(0).standard_normal((162, 8)) + 4.0 * np.outer(HEIGHT > 0.6, np.array(SEX) == "f")


@pytest.fixture
def folder(working_folder: Path) -> Path:
    sx.write("ball.surf.gii", BALL)
    for k, column in enumerate(DATA.T):
        sx.write(f"s{k}.npy", column)
    sx.write("all.npz", {f"s{k}": column for k, column in enumerate(DATA.T)})
    rows = ["id\tsex\tage\tpair", *(f"sub-{k}\t{SEX[k]}\t{AGE[k]}\t{pair}" for k, pair in enumerate("ABABCCDD"))]
    Path("subjects.tsv").write_text("\n".join(rows) + "\n")
    sx.write("halves.label.gii", LabelMap((HEIGHT > 0).astype(int), {0: "south", 1: "north"}), BALL)
    return working_folder


def test_groups_and_covariates_of_a_table(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--subjects", "subjects.tsv", "--groups", " sex", "--covariates", "age", "--count", "200", "--seed", "3"]
    more = [
        "--in-order",
        "--labels",
        "halves.label.gii",
        "--table",
        "clusters.csv",
        "--regions",
        "regions.csv",
        "--to",
        "found.npz",
    ]
    assert main(["test", "ball.surf.gii", *(f"s{k}.npy" for k in range(8)), *options, *more]) == 0
    surface = sx.read("ball.surf.gii")
    wanted = sx.permutation_test(surface, DATA, groups=SEX, covariates=AGE, count=200, seed=3)
    with np.load("found.npz") as found:
        for name, values in wanted.maps.items():
            np.testing.assert_array_equal(found[name], values)
    certificate = json.loads(Path("found.npz.json").read_text())
    assert certificate["tested"] == "f less m" and certificate["options"]["seed"] == 3
    assert {"subjects.tsv", "s0.npy", "halves.label.gii"} <= set(certificate["inputs"])
    with Path("clusters.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == len(wanted.clusters) > 0 and rows[0]["parcels"].startswith("north")
    assert [float(row["p_mass"]) for row in rows] == [one.p_mass for one in wanted.clusters]
    with Path("regions.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert [float(row["p_tfce"]) for row in rows] == [one.p_tfce for one in wanted.regions] and "p_mass" not in rows[0]
    said = capsys.readouterr().out
    assert said.count("region of") == len(wanted.regions) and ", north, p of TFCE " in said


def test_rows_belong_to_the_maps_that_they_name(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Rows in another order than the files, and rows without a file, change nothing."""
    rows = Path("subjects.tsv").read_text().replace("sub-", "s").splitlines()
    Path("subjects.tsv").write_text("\n".join([rows[0], *rows[:0:-1], "s77\tm\t50\tZ"]) + "\n")
    options = ["--subjects", "subjects.tsv", "--groups", "sex", "--covariates", "age", "--count", "200", "--seed", "3"]
    wanted = sx.permutation_test(BALL, DATA, groups=SEX, covariates=AGE, count=200, seed=3)
    for maps in ([f"s{k}.npy" for k in range(8)], ["all.npz"]):
        assert main(["test", "ball.surf.gii", *maps, *options, "--to", "found.npz"]) == 0
        assert "The rows of subjects.tsv are taken by column 'id' (1 without a map)." in capsys.readouterr().err
        with np.load("found.npz") as found:
            np.testing.assert_array_equal(found["t"], wanted.t)
            np.testing.assert_array_equal(found["p_tfce"], wanted.p_tfce)


def test_a_map_without_a_row_is_named(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = Path("subjects.tsv").read_text().replace("sub-", "s").replace("s3\t", "s33\t")
    Path("subjects.tsv").write_text(text)
    call = ["test", "ball.surf.gii", *(f"s{k}.npy" for k in range(8)), "--subjects", "subjects.tsv", "--groups", "sex"]
    assert main([*call, "--to", "found.npz"]) == 2
    assert "subjects.tsv: s3.npy has 0 rows by column 'id', one of its own is needed" in capsys.readouterr().err
    Path("subjects.tsv").write_text(text.replace("id\t", "").replace("\ns", "\n").partition("\n")[0] + "\nf\t1\tA\n")
    assert main([*call, "--in-order", "--to", "found.npz"]) == 2
    assert "subjects.tsv has 1 rows for 8 maps: give a row for each map in their order" in capsys.readouterr().err


def test_rows_are_in_the_order_of_several_files_only_where_that_is_said(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """s10.npy stands before s2.npy, and a table of 1, 2, ... was taken in that order."""
    names = [f"sub{k + 1}.npy" for k in range(12)]
    for k, name in enumerate(names):
        sx.write(name, DATA[:, k % 8] + k)
    rows = [f"{k + 1}\t{'fm'[k % 2]}\t{20 + k}" for k in range(12)]
    Path("subjects.tsv").write_text("\n".join(["id\tsex\tage", *rows]) + "\n")
    options = ["--subjects", "subjects.tsv", "--groups", "sex", "--count", "20", "--to", "found.npz"]
    assert main(["test", "ball.surf.gii", *sorted(names), *options]) == 2
    said = capsys.readouterr().err
    assert "subjects.tsv: no column names the 12 maps" in said and "--in-order" in said
    Path("named.tsv").write_text("\n".join(["id\tsex", "sub3\tf", "sub1\tm", *["x\tf"] * 5, *["y\tm"] * 5]) + "\n")
    assert main(["test", "ball.surf.gii", *sorted(names), *options, "--subjects", "named.tsv"]) == 2
    assert "named.tsv: no column names the 12 maps" in capsys.readouterr().err
    assert main(["test", "ball.surf.gii", *names, *options, "--in-order"]) == 0
    assert "The rows of subjects.tsv are taken in the order of the maps." in capsys.readouterr().err
    values = np.column_stack([DATA[:, k % 8] + k for k in range(12)])
    with np.load("found.npz") as found:
        np.testing.assert_array_equal(found["t"], sx.permutation_test(BALL, values, groups=[*"fm"] * 6, count=20).t)


@pytest.mark.parametrize(
    ("words", "maps", "rows"),
    [
        (["1", "2", "12"], ["sub_12.mgh", "sub_1.mgh", "sub_2.mgh"], [2, 0, 1]),
        (["sub-1", "sub-12"], ["d/sub-12_hemi-L.gii", "d/sub-1_hemi-L.gii"], [1, 0]),
        (["f", "m"], ["a.mgh", "b.mgh"], None),
        (["", ""], ["a.mgh", "b.mgh"], None),
    ],
)
def test_words_stand_alone_in_the_names_of_maps(words: list[str], maps: list[str], rows: list[int] | None) -> None:
    assert rows_of_maps({"id": words}, maps) == (rows and ("id", rows))


def test_one_file_of_all_maps_and_a_design(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    design = np.column_stack([np.array(SEX) == "f", np.array(SEX) == "m"]).astype(float)
    # without names 1,0 could be one number, but the contrast has two
    np.savetxt("design.csv", design, delimiter=",", fmt="%d")
    call = ["test", "ball.surf.gii", "all.npz", "--design", "design.csv", "--contrast", "1,-1", "--one-sided"]
    assert main([*call, "--to", "found.func.gii"]) == 0
    wanted = sx.permutation_test(BALL, DATA, design, [1, -1], two_sided=False)
    certificate = json.loads(Path("found.func.gii.json").read_text())
    assert certificate["rearrangements"] == wanted.facts["rearrangements"] == "all 70 permutations that differ"
    assert certificate["exact"] is True and certificate["options"]["two_sided"] is False
    found = read_maps("found.func.gii")
    np.testing.assert_allclose(found["p_tfce"], wanted.p_tfce, rtol=1e-6)
    assert main(["test", "ball.surf.gii", "all.npz", "--level", "0.001", "--to", "mean.npz"]) == 0
    least = np.nanmin(sx.permutation_test(BALL, DATA).p_tfce)
    assert f"no vertex has a family-wise p of TFCE up to 0.001; the least is {least:.3g}" in capsys.readouterr().out


def test_pairs_of_a_table(folder: Path) -> None:
    call = ["test", "ball.surf.gii", "all.npz", "--subjects", "subjects.tsv", "--groups", "sex", "--pairs", "pair"]
    assert main([*call, "--to", "found.npz"]) == 0
    certificate = json.loads(Path("found.npz.json").read_text())
    assert certificate["tested"] == "f less m in pairs"
    assert certificate["options"]["groups"] == "sex" and certificate["options"]["pairs"] == "pair"


def test_blocks_flip_as_wholes_where_they_are_asked_to(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    call = ["test", "ball.surf.gii", "all.npz", "--subjects", "subjects.tsv", "--blocks", "pair"]
    assert main([*call, "--to", "found.npz"]) == 2
    assert "choose exchange = 'whole'" in capsys.readouterr().err
    assert main([*call, "--exchange", "whole", "--rearrange", "flip", "--to", "found.npz"]) == 0
    certificate = json.loads(Path("found.npz.json").read_text())
    assert certificate["rearrangements"] == "all 16 sign flips that differ"
    assert certificate["options"]["exchange"] == "whole" and certificate["options"]["rearrange"] == "flip"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--groups", "sex"], "--groups names a column: give --subjects FILE"),
        (["--subjects", "subjects.tsv", "--groups", "sexe"], "--groups = 'sexe', choose one of id, sex, age, pair"),
        (["--subjects", "subjects.tsv", "--covariates", "sex"], "sex has 'f', a number is needed"),
        (["--subjects", "none.tsv", "--groups", "sex"], "none.tsv: no such file"),
        (["--in-order"], "--in-order is of the rows of a table: give --subjects FILE"),
        (["--subjects", "none.tsv"], "--subjects none.tsv says nothing of the test: name a column"),
        (["all.npz"], "map all.npz is given more than once, each subject counts once"),
        (["./all.npz"], "map all.npz is given more than once"),
        (["--contrast", "1,x"], "--contrast has 'x', a number is needed"),
        (["--labels", "all.npz"], "is no file of labels"),
        (["--table", "clusters.xls"], "choose .csv"),
        (["--table", "subjects.csv/a.csv"], "subjects.csv"),
        (["--table", "a.csv", "--regions", "a.csv"], "a.csv is the file of two results: give each its own"),
        (["--table", "found.csv", "--to", "found.csv"], "found.csv is the file of two results: give each its own"),
        (["--regions", "regions.xls"], "--regions regions.xls has an unknown format, choose .csv"),
    ],
)
def test_mistakes_are_told_in_one_line(
    folder: Path, arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["test", "ball.surf.gii", "all.npz", "--to", "found.npz", *arguments]) == 2
    said = capsys.readouterr().err.strip()
    assert line in said and len(said.splitlines()) == 1 and not Path("found.npz").exists()


def test_a_target_has_room_for_eight_maps(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("surfexp.tasks.permutation_testing.permutation_test", None)
    assert main(["test", "ball.surf.gii", "all.npz", "--to", "found.npy"]) == 2
    assert "holds one map, there are 8" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("id,age\n", "has 1 rows"),
        ("id,id\n1,2\n", "two columns have the name 'id'"),
        ("id,age\na,1\nb\n", "row 3 has 1 cells, 2 are needed"),
    ],
)
def test_tables_of_subjects_that_are_none(working_folder: Path, text: str, line: str) -> None:
    Path("table.csv").write_text(text)
    with pytest.raises(ValueError, match=line):
        read_subjects("table.csv")


@pytest.mark.parametrize("between", [",", ";", "\t"])
def test_columns_of_subjects_are_separated_as_spreadsheets_do(working_folder: Path, between: str) -> None:
    rows = [["id", "sex", "age"], ["a", "f", "23.5"], ["b", "Müller; m", "1,5"]]
    Path("table.csv").write_text("\n".join(between.join(f'"{cell}"' for cell in row) for row in rows), "utf-8")
    assert read_subjects("table.csv") == {"id": ["a", "b"], "sex": ["f", "Müller; m"], "age": ["23.5", "1,5"]}
    Path("table.csv").write_text("id,sex\nMüller,f\n", "latin-1")
    with pytest.raises(ValueError, match=r"table.csv cannot be read as a table of subjects: byte 8 is no UTF-8 text"):
        read_subjects("table.csv")
