"""Spectra of many structures as one table in BrainPrint's layout."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.fingerprint_sources import structures

BODY = sx.shape("ellipsoid", levels=3)


@pytest.fixture
def subjects(working_folder: Path) -> Path:
    """Three people: one whole, one without its right hemisphere, one with a broken file."""
    for scale, person in enumerate(("anna", "bela", "cleo"), 1):
        folder = working_folder / "subjects" / person / "surf"
        folder.mkdir(parents=True)
        for name in ("lh.white", "lh.pial", "rh.white", "rh.pial")[: 2 if person == "bela" else 4]:
            sx.write(folder / name, Surface(TriangleMesh(scale * BODY.mesh.vertices, BODY.mesh.faces)))
    (working_folder / "subjects" / "cleo" / "surf" / "rh.pial").write_bytes(b"\xff\xff\xfe broken")
    (working_folder / "subjects" / "fsaverage-notes.txt").write_text("not a person")
    return working_folder / "subjects"


def read(path: str) -> tuple[list[str], dict[str, list[str]]]:
    with Path(path).open() as stream:
        header, *rows = list(csv.reader(stream))
    return header[1:], {row[0]: row[1:] for row in rows}


def test_a_subjects_folder_becomes_one_table(subjects: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fingerprint", "subjects", "-k", "5", "--to", "table.csv"]) == 0
    header, rows = read("table.csv")
    assert len(header) == 9 and header[:2] == ["anna lh-white-2d", "anna lh-pial-2d"]
    assert list(rows) == ["area", "volume", *(f"ev{k}" for k in range(5)), "residual", "complete", "repairs"]
    direct = sx.eigenpairs(subjects / "anna" / "surf" / "lh.white", 5)
    assert [float(rows[f"ev{k}"][0]) for k in range(1, 5)] == pytest.approx(direct.values[1:], rel=1e-8)
    assert rows["ev0"] == ["0.0"] * 9 and set(rows["complete"]) == {"1"}
    assert max(map(float, rows["residual"])) <= 1e-8
    first, second = header.index("anna lh-white-2d"), header.index("bela lh-white-2d")
    assert float(rows["area"][second]) == pytest.approx(4 * float(rows["area"][first]), rel=1e-5)
    assert float(rows["volume"][second]) == pytest.approx(8 * float(rows["volume"][first]), rel=1e-5)
    said = capsys.readouterr()
    assert "left out: cleo rh-pial-2d" in said.err and "9 structures, 1 left out" in said.out
    proof = json.loads(Path("table.csv.json").read_text())
    assert proof["complete"] is True and len(proof["inputs"]) == 9 and "cleo rh-pial-2d" in proof["left_out"]


def test_files_folders_and_repairs(working_folder: Path) -> None:
    Path("shapes/deep").mkdir(parents=True)
    sx.write("shapes/a.ply", BODY)
    turned = BODY.mesh.faces.copy()
    turned[:5] = turned[:5, ::-1]
    sx.write("shapes/deep/b.off", Surface(TriangleMesh(BODY.mesh.vertices, turned)))
    table = sx.fingerprint("shapes", count=4)
    assert list(table.columns) == ["a", "deep/b"]
    assert table.columns["deep/b"] == pytest.approx(table.columns["a"], rel=1e-6)
    assert "turned over" in table.repairs["deep/b"][0] and table.rows()["repairs"] == [0, 1]
    strict = sx.fingerprint(["shapes/a.ply", "shapes/deep/b.off"], count=4, repair=False)
    assert list(strict.columns) == ["a"] and "flipped" in strict.refused["b"]


def test_an_open_surface_has_no_volume(working_folder: Path) -> None:
    sx.write("disk.ply", sx.shape("disk"))
    table = sx.fingerprint("disk.ply", count=3)
    assert np.isnan(table.columns["disk"][1]) and table.columns["disk"][0] > 0
    table.save("disk.csv")
    assert read("disk.csv")[1]["volume"] == [""]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["fingerprint", "nowhere", "--to", "a.csv"], "nowhere"),
        (["fingerprint", ".", "--to", "a.csv"], "no surface in"),
        (["fingerprint", ".", "--to", "a.xls"], "choose .csv"),
        (["fingerprint", ".", "-k", "0", "--to", "a.csv"], "count = 0"),
    ],
)
def test_mistakes_are_one_line(
    working_folder: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], words: str
) -> None:
    assert main(arguments) == 2 and words in capsys.readouterr().err


def segmentation(path: Path, extra: tuple[int, ...] = ()) -> None:
    """An aseg with two hippocampi, a ball of 9 mm and one of half its volume, a stray voxel and a torus as brain stem."""
    import nibabel

    x, y, z = np.meshgrid(*[np.arange(60) - 30.0] * 3, indexing="ij")
    labels = np.zeros(x.shape, dtype=np.int32)
    labels[(x + 16) ** 2 + y**2 + z**2 <= 81] = 17
    labels[(x - 16) ** 2 + y**2 + z**2 <= 81 * 0.5 ** (2 / 3)] = 53
    labels[0, 0, 0] = 53
    labels[(np.hypot(x, y) - 16) ** 2 + (z - 20) ** 2 <= 20] = 16
    path.parent.mkdir(parents=True, exist_ok=True)
    kind = nibabel.MGHImage if path.suffix == ".mgz" else nibabel.Nifti1Image
    nibabel.save(kind(labels, np.diag([1.0, 1.0, 1.0, 1.0])), path)


def test_structures_of_aseg_are_closed_surfaces(working_folder: Path) -> None:
    segmentation(Path("people/anna/mri/aseg.mgz"))
    table = sx.fingerprint("people", count=5)
    # Cerebellum and Brain-Stem share a label, as in BrainPrint
    assert set(table.columns) == {
        f"anna {n}" for n in ("Left-Hippocampus", "Right-Hippocampus", "Brain-Stem", "Cerebellum")
    }
    left, right = (table.columns[f"anna {side}-Hippocampus"] for side in ("Left", "Right"))
    assert left[1] == pytest.approx(4 / 3 * np.pi * 9**3, rel=0.06) and right[1] == pytest.approx(left[1] / 2, rel=0.08)
    assert left[2] == 0 and left[3:6] == pytest.approx(2 / 81, rel=0.06)
    assert "off the largest piece" in table.repairs["anna Right-Hippocampus"][0]
    assert "genus 1 stays" in table.repairs["anna Brain-Stem"][0]
    assert all(table.complete.values())


def test_derivatives_and_damaged_volumes(working_folder: Path) -> None:
    segmentation(Path("derivatives/sub-01/anat/sub-01_desc-aseg_dseg.nii.gz"))
    sx.write("derivatives/sub-01/anat/sub-01_hemi-L_white.surf.gii", BODY)
    names = list(sx.fingerprint("derivatives", count=2).columns)
    assert names[0] == "sub-01/anat/sub-01_hemi-L_white" and "sub-01/anat/sub-01 Left-Hippocampus" in names
    Path("bad/mri").mkdir(parents=True)
    Path("bad/mri/aseg.mgz").write_bytes(b"\x1f\x8b nothing")
    damaged = sx.fingerprint("bad")
    assert not damaged.columns and "no volume that can be read" in damaged.refused["aseg.mgz"]


def test_one_value_is_a_fingerprint(working_folder: Path) -> None:
    sx.write("ball.ply", sx.shape("icosphere", levels=2))
    alone, several = (sx.fingerprint(["ball.ply"], count=count).columns["ball"] for count in (1, 3))
    assert len(several) == len(alone) + 2 and alone[2] == several[2]


def test_fifty_values_are_the_default_as_in_brainprint(working_folder: Path) -> None:
    sx.write("body.ply", BODY)
    (values,) = sx.fingerprint("body.ply").columns.values()
    assert np.array_equal(values, next(iter(sx.fingerprint("body.ply", count=50).columns.values())), equal_nan=True)


def test_labels_of_structures_are_those_of_freesurfer() -> None:
    """A union has the labels of its parts, and both sides have the same structures, 39 labels apart where one is."""
    from surfexp.anatomy.aseg import STRUCTURES

    assert set(STRUCTURES["Left-Striatum"]) == {
        code for part in ("Caudate", "Putamen", "Accumbens-area") for code in STRUCTURES[f"Left-{part}"]
    }
    left = {name.removeprefix("Left-"): codes for name, codes in STRUCTURES.items() if name.startswith("Left-")}
    right = {name.removeprefix("Right-"): codes for name, codes in STRUCTURES.items() if name.startswith("Right-")}
    # FreeSurferColorLUT: deep grey matter of the right is 39 above that of the left up to pallidum, 36 from hippocampus
    apart = {name: right[name][0] - left[name][0] for name in left}
    assert left.keys() == right.keys()
    assert {name for name, by in apart.items() if by == 39} >= {"Thalamus-Proper", "Caudate", "Putamen", "Pallidum"}
    assert apart["Hippocampus"] == apart["Amygdala"] == 36 and apart["Accumbens-area"] == apart["VentralDC"] == 32
    single = [codes[0] for codes in [*left.values(), *right.values()] if len(codes) == 1]
    assert len(set(single)) == len(single)


def test_a_volume_with_a_single_fraction_holds_no_labels(tmp_path: Path) -> None:
    import nibabel

    from surfexp.anatomy.aseg import read_label_volume

    values = np.ones((4, 4, 4))
    values[1, 2, 3] = 0.5
    nibabel.save(nibabel.Nifti1Image(values, np.eye(4)), tmp_path / "volume.nii.gz")
    with pytest.raises(ValueError, match="holds fractions"):
        read_label_volume(tmp_path / "volume.nii.gz")


def test_the_summary_names_the_largest_residual(working_folder: Path) -> None:
    for name, scale in (("one", 1.0), ("two", [1.0, 1.3, 0.8])):
        ball = sx.shape("icosphere", levels=3).mesh
        sx.write(f"{name}.off", Surface(TriangleMesh(ball.vertices * np.array(scale), ball.faces)))
    table = sx.fingerprint(".", 10)
    table = replace(table, residuals=dict(zip(table.residuals, (3e-9, 5e-12), strict=True)))
    assert "3e-09" in repr(table) and "5e-12" not in repr(table)


def test_surfaces_of_one_name_are_told_apart_by_their_paths(subjects: Path) -> None:
    files = [subjects / person / "surf" / "lh.white" for person in ("anna", "bela")]
    assert set(structures(files)) == {"anna/surf/lh.white", "bela/surf/lh.white"}
    people = structures([subjects / "anna", subjects / "bela"])
    assert people.items() <= structures([subjects]).items()
    assert {"anna lh-white-2d", "bela lh-white-2d"} <= set(people)
    beside = subjects / "ball.ply"
    sx.write(beside, BODY)
    sx.write(subjects / "ball.off", BODY)
    assert list(structures([beside, files[0], subjects / "ball.off", beside])) == ["ball.ply", "lh.white", "ball.off"]


def test_a_file_of_both_hemispheres_has_a_column_for_each(working_folder: Path) -> None:
    for side, scale in (("lh", 1.0), ("rh", 2.0)):
        sx.write(f"{side}.ply", Surface(TriangleMesh(scale * BODY.mesh.vertices, BODY.mesh.faces)))
    sx.write("both.npz", sx.read(left="lh.ply", right="rh.ply"))
    assert main(["fingerprint", "both.npz", "lh.ply+rh.ply", "-k", "3", "--to", "table.csv"]) == 0
    header, rows = read("table.csv")
    assert header == ["both left", "both right", "lh", "rh"]
    for name, numbers in rows.items():
        assert name == "residual" or numbers[:2] == numbers[2:]
    assert set(json.loads(Path("table.csv.json").read_text())["inputs"]) == {"both.npz", "lh.ply", "rh.ply"}


def test_one_value_is_enough(working_folder: Path) -> None:
    sx.write("body.ply", BODY)
    assert sx.fingerprint(["body.ply"], count=1).columns["body"].shape == (3,)
    with pytest.raises(ValueError, match="count = 0"):
        sx.fingerprint(["body.ply"], count=0)
