"""Labels keep the colours of their file's own table, in every format, and pictures and pages show them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.io.label_colours import read_coloured_labels
from surfexp.mesh.coloured_labels import ColouredLabels, coloured_as
from surfexp.mesh.label_map import LabelMap

nibabel = pytest.importorskip("nibabel")

BALL = sx.shape("icosphere", levels=3)
N = len(BALL.mesh.vertices)
KEYS = np.where(BALL.mesh.vertices[:, 2] > 0.4, 2, np.where(BALL.mesh.vertices[:, 2] < -0.4, 1, 0))
# of FreeSurfer's Desikan-Killiany: unknown, insula, precuneus
BYTES = np.array([[25, 5, 25], [255, 192, 32], [160, 140, 180]])
COLORS = {key: tuple(row) for key, row in enumerate((BYTES / 255.0).tolist())}


def _annot(path: Path, rows: np.ndarray) -> None:
    table = np.column_stack([rows, np.zeros(3, int)]).astype(np.int32)
    nibabel.freesurfer.write_annot(path, KEYS.astype(np.int32), table, [b"unknown", b"insula", b"precuneus"])


def _gifti(path: Path, rows: np.ndarray, alpha: float = 1.0) -> None:
    table = nibabel.gifti.GiftiLabelTable()
    for key, (name, row) in enumerate(zip(("???", "insula", "precuneus"), rows, strict=True)):
        entry = nibabel.gifti.GiftiLabel(key, *map(float, row), alpha)
        entry.label = name
        table.labels.append(entry)
    data = nibabel.gifti.GiftiDataArray(KEYS.astype(np.int32), "NIFTI_INTENT_LABEL", datatype="NIFTI_TYPE_INT32")
    nibabel.save(nibabel.gifti.GiftiImage(labeltable=table, darrays=[data]), path)


def _dlabel(path: Path, rows: np.ndarray) -> None:
    names = ("???", "insula", "precuneus")
    table = {key: (names[key], (*map(float, row), float(key > 0))) for key, row in enumerate(rows)}
    brain = nibabel.cifti2.BrainModelAxis.from_mask(np.ones(N, bool), "CIFTI_STRUCTURE_CORTEX_LEFT")
    axes = (nibabel.cifti2.LabelAxis(["parts"], [table]), brain)
    nibabel.save(nibabel.cifti2.Cifti2Image(KEYS[None].astype(np.float32), axes), path)


WRITERS: dict[str, Callable[[Path], None]] = {
    "lh.parts.annot": lambda path: _annot(path, BYTES),
    "lh.parts.label.gii": lambda path: _gifti(path, BYTES / 255.0),
    "lh.bytes.label.gii": lambda path: _gifti(path, BYTES),
    "parts.dlabel.nii": lambda path: _dlabel(path, BYTES / 255.0),
}


@pytest.mark.parametrize("name", WRITERS)
def test_the_colours_of_a_file_are_read_and_drawn(tmp_path: Path, name: str) -> None:
    WRITERS[name](tmp_path / name)
    table = read_coloured_labels(tmp_path / name, "left")
    assert np.array_equal(table.keys, KEYS)
    for key in (1, 2):
        np.testing.assert_allclose(table.colors[key], COLORS[key], atol=1e-6)
    for given in (table, str(tmp_path / name)):
        ((shown,),) = sx.plot(sx.Surface(BALL.mesh, hemisphere="left"), given, views="top", width=200).views
        assert shown.labels is not None and shown.labels.names == ("insula", "precuneus")
        np.testing.assert_allclose(shown.labels.colors, BYTES[1:] / 255.0, atol=1e-6)


def test_a_page_turns_labels_in_their_own_colours_and_a_part_keeps_them(tmp_path: Path) -> None:
    _annot(tmp_path / "lh.parts.annot", BYTES)
    sx.write(tmp_path / "lh.ball.ply", BALL)
    brain = sx.read(tmp_path / "lh.ball.ply", labels={"parts": tmp_path / "lh.parts.annot"})
    field = sx.view(brain, "parts").scene.surfaces[0].fields[0]
    assert field.labels is not None
    np.testing.assert_allclose(field.labels.colors, BYTES[1:] / 255.0, atol=1e-6)


def test_both_hemispheres_keep_the_colours_of_each_file_by_name(tmp_path: Path) -> None:
    for letter in "lr":
        _annot(tmp_path / f"{letter}h.parts.annot", BYTES if letter == "l" else BYTES[[0, 2, 1]])
        sx.write(tmp_path / f"{letter}h.ball.ply", BALL)
    pair = {side: tmp_path / f"{side[0]}h.parts.annot" for side in ("left", "right")}
    left, right = (tmp_path / f"{letter}h.ball.ply" for letter in "lr")
    brain = sx.read(left=left, right=right, labels={"parts": pair})
    for row in sx.plot(brain, "parts", width=400).views:
        for one in row:
            assert one.labels is not None
            np.testing.assert_allclose(one.labels.colors, BYTES[1:] / 255.0, atol=1e-6)


def test_a_table_that_says_nothing_by_its_colours_has_none(tmp_path: Path) -> None:
    _gifti(tmp_path / "lh.black.label.gii", np.zeros((3, 3)))
    assert read_coloured_labels(tmp_path / "lh.black.label.gii").colors == {}
    _gifti(tmp_path / "lh.clear.label.gii", BYTES / 255.0, alpha=0.0)
    assert read_coloured_labels(tmp_path / "lh.clear.label.gii").colors == {}
    for name in ("lh.own.annot", "lh.own.label.gii"):
        sx.write(tmp_path / name, LabelMap(KEYS, {0: "unknown", 1: "insula", 2: "precuneus"}), BALL)
        assert read_coloured_labels(tmp_path / name).colors == {}


def test_a_label_without_a_colour_takes_a_made_one() -> None:
    table = ColouredLabels(KEYS, {0: "unknown", 1: "insula", 2: "precuneus"}, {2: (0.1, 0.2, 0.3)})
    ((shown,),) = sx.plot(BALL, table, views="top", width=200).views
    assert shown.labels is not None and shown.labels.colors[1].tolist() == [0.1, 0.2, 0.3]
    assert shown.labels.colors[0].tolist() != [0.1, 0.2, 0.3]
    plain = LabelMap(KEYS, table.names)
    assert coloured_as(plain, plain) is plain
    again = coloured_as(plain, ColouredLabels(KEYS, {7: "insula"}, {7: (1.0, 0.0, 0.0)}), table)
    assert isinstance(again, ColouredLabels) and again.by_name == {
        "insula": (1.0, 0.0, 0.0),
        "precuneus": (0.1, 0.2, 0.3),
    }


@pytest.mark.parametrize("name", ["lh.again.annot", "lh.again.label.gii"])
def test_colours_are_written_again(tmp_path: Path, name: str) -> None:
    _annot(tmp_path / "lh.parts.annot", BYTES)
    table = read_coloured_labels(tmp_path / "lh.parts.annot")
    none = ColouredLabels(np.where(KEYS == 1, -1, KEYS), table.names, table.colors)
    sx.write(tmp_path / name, none, BALL)
    again = read_coloured_labels(tmp_path / name)
    assert np.array_equal(again.keys, none.keys) and again.names == table.names
    assert sorted(again.colors) == [0, 1, 2]
    for key, color in table.colors.items():
        np.testing.assert_allclose(again.colors[key], color, atol=1e-6)


def test_black_and_a_colour_of_another_label_do_not_join_labels_of_an_annotation(tmp_path: Path) -> None:
    red, black = (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    keys = np.where(np.arange(N) % 5, KEYS, -1)
    table = ColouredLabels(keys, {0: "a", 1: "b", 2: "c"}, {0: red, 1: red, 2: black})
    for name in ("lh.alike.annot", "lh.alike.label.gii"):
        sx.write(tmp_path / name, table, BALL)
        again = read_coloured_labels(tmp_path / name)
        assert np.array_equal(again.keys, keys) and again.colors[0] == red
    assert again.colors == table.colors
