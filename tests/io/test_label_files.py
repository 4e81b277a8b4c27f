"""Labels and tables that other tools open: what is written is what nibabel reads back."""

from __future__ import annotations

from pathlib import Path

import nibabel
import numpy as np
import pytest

from surfexp.io.label_files import label_colors, read_labels, write_labels
from surfexp.io.map_files import read_mask

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


def test_a_label_file_without_names_is_a_mask_by_its_numbers(tmp_path: Path) -> None:
    keys = np.array([0, 1, 1, 0, 1], dtype=np.int32)
    array = nibabel.gifti.GiftiDataArray(keys, intent="NIFTI_INTENT_LABEL")
    nibabel.save(nibabel.gifti.GiftiImage(darrays=[array]), tmp_path / "medmask.label.gii")
    assert read_mask(tmp_path / "medmask.label.gii", 5).tolist() == [False, True, True, False, True]
    with pytest.raises(ValueError, match="cortex"):
        read_mask(f"{tmp_path / 'medmask.label.gii'}:cortex", 5)
