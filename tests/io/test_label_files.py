"""Labels and tables that other tools open: what is written is what nibabel reads back."""

from __future__ import annotations

import csv
from pathlib import Path

import nibabel
import numpy as np
import pytest

from surfexp.io.label_files import label_colors, read_labels, write_labels
from surfexp.io.map_files import read_mask
from surfexp.io.vtk import write_vtk
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.studies.sulci.sulcal_export import export_sulci, sulcus_names, write_length_table
from surfexp.studies.sulci.sulcal_measurement import NamedSulci

NAMES = ("unknown", "central", "calcarine", "superior temporal")


@pytest.mark.parametrize("name", ["lh.sulci.label.gii", "lh.sulci.annot"])
def test_labels_and_names_come_back(tmp_path, name: str) -> None:
    labels = np.random.default_rng(0).integers(0, 4, 500)
    write_labels(tmp_path / name, labels, NAMES)
    found, names = read_labels(tmp_path / name)
    assert np.array_equal(found, labels) and names == NAMES


def test_nibabel_alone_reads_them(tmp_path) -> None:
    labels = np.array([0, 3, 1, 1, 2])
    write_labels(tmp_path / "a.label.gii", labels, NAMES)
    image = nibabel.load(tmp_path / "a.label.gii")
    assert image.darrays[0].intent == nibabel.nifti1.intent_codes["NIFTI_INTENT_LABEL"]
    assert image.agg_data().tolist() == labels.tolist()
    assert image.labeltable.get_labels_as_dict() == dict(enumerate(NAMES))
    write_labels(tmp_path / "a.annot", labels, NAMES)
    found, table, names = nibabel.freesurfer.read_annot(tmp_path / "a.annot")
    assert found.tolist() == labels.tolist() and [entry.decode() for entry in names] == list(NAMES)
    assert np.array_equal(table[:, :3], label_colors(4))


def test_a_foreign_table_with_gaps_is_numbered_from_zero(tmp_path) -> None:
    table = nibabel.gifti.GiftiLabelTable()
    for key, name in ((7, "b"), (2, "a")):
        entry = nibabel.gifti.GiftiLabel(key, 1.0, 0.0, 0.0, 1.0)
        entry.label = name
        table.labels.append(entry)
    values = np.array([7, 2, 7, 5], np.int32)
    array = nibabel.gifti.GiftiDataArray(values, "NIFTI_INTENT_LABEL", datatype="NIFTI_TYPE_INT32")
    nibabel.save(nibabel.gifti.GiftiImage(labeltable=table, darrays=[array]), tmp_path / "other.label.gii")
    found, names = read_labels(tmp_path / "other.label.gii")
    assert found.tolist() == [1, 0, 1, -1] and names == ("a", "b")


def test_no_two_labels_share_a_colour() -> None:
    colors = label_colors(5000)
    assert colors.min() >= 0 and colors.max() <= 255
    assert len(np.unique(colors, axis=0)) == 5000


def test_what_cannot_be_written_or_read_is_refused(tmp_path) -> None:
    with pytest.raises(ValueError, match=r"labels go from 0 to 4, the 4 names are of 0\.\.3"):
        write_labels(tmp_path / "a.annot", np.array([0, 4]), NAMES)
    with pytest.raises(ValueError, match="'a' stands for two labels"):
        write_labels(tmp_path / "a.annot", np.array([0]), ("a", "a"))
    with pytest.raises(ValueError, match="unknown format of labels"):
        write_labels(tmp_path / "a.txt", np.array([0]), NAMES)
    with pytest.raises(ValueError, match="is not there"):
        read_labels(tmp_path / "none.annot")
    for name in ("broken.annot", "broken.label.gii"):
        (tmp_path / name).write_bytes(b"no labels")
        with pytest.raises(ValueError, match="not a readable file of labels"):
            read_labels(tmp_path / name)


def test_sulci_are_exported_for_three_tools(tmp_path) -> None:
    from surfexp.mesh.surface import Surface

    mesh = icosphere(2).mesh
    own = np.where(mesh.vertices[:, 2] > 0.5, 1, -1)
    named = NamedSulci(np.arange(len(own)), np.full(len(own), 2), own)
    files = export_sulci(tmp_path / "out", "left @ anna", Surface(mesh), named, 3)
    assert [file.name for file in files] == ["left_anna.label.gii", "left_anna.annot", "left_anna.vtk"]
    for file in files[:2]:
        labels, names = read_labels(file)
        assert np.array_equal(labels, own + 1) and names == sulcus_names(3)
    write_vtk(tmp_path / "left_anna.vtk", mesh, {"own region": own + 1.0, "carried region": np.full(len(own), 3.0)})
    assert files[2].read_text() == (tmp_path / "left_anna.vtk").read_text()


def test_lengths_are_written_with_gaps(tmp_path) -> None:
    columns = {"sulcus": np.array([1.0, 2.0]), "geodesic": np.array([12.25, np.nan])}
    write_length_table(tmp_path / "lengths.csv", ("anna, left, sulcus 1", "anna, left, sulcus 2"), columns)
    with (tmp_path / "lengths.csv").open() as stream:
        rows = list(csv.reader(stream))
    assert rows[0] == ["row", "sulcus", "geodesic"]
    assert rows[1] == ["anna, left, sulcus 1", "1", "12.25"] and rows[2][2] == ""


def test_a_label_file_without_names_is_a_mask_by_its_numbers(tmp_path: Path) -> None:
    keys = np.array([0, 1, 1, 0, 1], dtype=np.int32)
    array = nibabel.gifti.GiftiDataArray(keys, intent="NIFTI_INTENT_LABEL")
    nibabel.save(nibabel.gifti.GiftiImage(darrays=[array]), tmp_path / "medmask.label.gii")
    assert read_mask(tmp_path / "medmask.label.gii", 5).tolist() == [False, True, True, False, True]
    with pytest.raises(ValueError, match="cortex"):
        read_mask(f"{tmp_path / 'medmask.label.gii'}:cortex", 5)
