"""Maps of two hemispheres belong together by name; files that hold both say which rows are whose."""

from __future__ import annotations

from pathlib import Path

import nibabel as nib
import numpy as np
import pandas as pd
import pytest
from nibabel import cifti2

import surfexp as sx
from surfexp.io.hemisphere import hemisphere_of_file
from surfexp.io.map_files import read_maps
from surfexp.mesh.both_hemispheres import joined
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface

BALL = icosphere(1).mesh
COUNT = len(BALL.vertices)
X, Y, Z = BALL.vertices.T
BRAIN = joined(Surface(BALL), Surface(BALL))
MODELS = cifti2.BrainModelAxis.from_mask(np.ones(COUNT, bool), name="CIFTI_STRUCTURE_CORTEX_LEFT")
MODELS += cifti2.BrainModelAxis.from_mask(np.ones(COUNT, bool), name="CIFTI_STRUCTURE_CORTEX_RIGHT")


def dscalar(path: str, names: list[str]) -> None:
    """Write maps that are 1, 2, 3, ... everywhere."""
    rows = np.repeat(np.arange(1.0, len(names) + 1)[:, None], 2 * COUNT, axis=1)
    header = cifti2.Cifti2Header.from_axes((cifti2.ScalarAxis(names), MODELS))
    nib.save(cifti2.Cifti2Image(rows.astype(np.float32), header), path)


def means(given: object) -> list[float]:
    """Means of the maps that a function of the face takes something for."""
    return sx.smooth(BRAIN, given, 0.01).values.reshape(2 * COUNT, -1).mean(axis=0).round(6).tolist()  # type: ignore[arg-type]


def test_maps_of_one_name_belong_together_in_any_order(working_folder: Path) -> None:
    pd.DataFrame({"thickness": 2.5 + 0 * X, "sulc": -1 + 0 * X}).to_csv("lh.m.csv", index=False)
    pd.DataFrame({"sulc": -1 + 0 * X, "thickness": 2.5 + 0 * X}).to_csv("rh.m.csv", index=False)
    assert means({"left": "lh.m.csv", "right": "rh.m.csv"}) == [2.5, -1.0]
    pd.DataFrame({"rh.sulc": -1 + 0 * X, "rh.thickness": 2.5 + 0 * X}).to_csv("rh.m.csv", index=False)
    pd.DataFrame({"lh.thickness": 2.5 + 0 * X, "lh.sulc": -1 + 0 * X}).to_csv("lh.m.csv", index=False)
    assert means({"left": "lh.m.csv", "right": "rh.m.csv"}) == [2.5, -1.0]
    pd.DataFrame({"area": -1 + 0 * X, "thickness": 2.5 + 0 * X}).to_csv("rh.m.csv", index=False)
    with pytest.raises(
        ValueError, match=r"lh.m.csv has 2 maps, rh.m.csv has 2, and 'area', 'lh.sulc'.* the same names"
    ):
        means({"left": "lh.m.csv", "right": "rh.m.csv"})


def test_contrasts_of_left_and_right_hands_stay_apart(working_folder: Path) -> None:
    dscalar("tfMRI_MOTOR_LH.dscalar.nii", ["MOTOR_LH", "MOTOR_RH", "MOTOR_T"])
    assert means("tfMRI_MOTOR_LH.dscalar.nii") == [1.0, 2.0, 3.0]
    assert hemisphere_of_file("tfMRI_MOTOR_LH.dscalar.nii") == ""


def test_maps_of_equal_names_are_all_there(working_folder: Path) -> None:
    dscalar("merged.dscalar.nii", ["pre", "post"] * 3)
    assert means("merged.dscalar.nii") == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    assert list(read_maps("merged.dscalar.nii", "left"))[:3] == ["pre", "post", "pre 3"]


def test_an_archive_serves_both_sides_where_it_says_which_rows_are_whose(working_folder: Path) -> None:
    np.savez("one.npz", thickness=X)
    for call in (lambda: means("one.npz"), lambda: sx.read(left="lh.ply", right="rh.ply", maps="one.npz")):
        for side in "lr":
            sx.write(f"{side}h.ply", (BALL.vertices, BALL.faces))
        with pytest.raises(ValueError, match=r"one.npz does not say which rows are left and right: give .'left'"):
            call()
    np.savez("one.npz", thickness=X, hemisphere=np.array("left"))
    for given in ({"maps": "one.npz"}, {"mask": "one.npz"}):
        with pytest.raises(ValueError, match=r"one.npz does not say which rows are left and right"):
            sx.read(left="lh.ply", right="rh.ply", **given)  # type: ignore[arg-type]
    np.savez("both.npz", thickness=np.repeat([1.0, 3.0], COUNT), hemisphere=np.repeat(["left", "right"], COUNT))
    assert means("both.npz") == [2.0]
    np.savez("short.npz", thickness=np.repeat([1.0, 3.0], COUNT), hemisphere=np.repeat(["L", "R"], COUNT))
    with pytest.raises(ValueError, match=r"'L'.*'left' and 'right'"):
        means("short.npz")


@pytest.mark.parametrize("side", ["left", "right"])
def test_what_is_known_on_one_side_alone_is_written(working_folder: Path, side: str) -> None:
    known = np.repeat([side == "left", side == "right"], COUNT)
    sx.write("one.dscalar.nii", np.where(known, 2.0, np.nan), BRAIN)
    assert np.array_equal(read_maps("one.dscalar.nii", side)["one"], np.full(COUNT, 2.0))
    assert hemisphere_of_file("one.dscalar.nii") == side


def test_pandas_index_is_no_map(working_folder: Path) -> None:
    pd.DataFrame({"a": X, "b": Y}).to_csv("lh.csv")
    assert list(read_maps("lh.csv")) == ["a", "b"] and np.array_equal(read_maps("lh.csv")["b"], Y)
    pd.DataFrame({"a": X, "b": Y}, index=np.arange(1, COUNT + 1)).to_csv("lh.csv")
    assert list(read_maps("lh.csv")) == ["a", "b"]
    pd.DataFrame({"a": X, "b": Y}, index=np.arange(COUNT)[::-1]).to_csv("lh.csv")
    with pytest.raises(ValueError, match="does not count the rows"):
        read_maps("lh.csv")


def test_vertices_behind_the_last_that_a_file_lists_are_unknown(working_folder: Path) -> None:
    values = nib.gifti.GiftiDataArray(Z[:30].astype(np.float32), "NIFTI_INTENT_SHAPE")
    nodes = nib.gifti.GiftiDataArray(np.arange(30, dtype=np.int32), "NIFTI_INTENT_NODE_INDEX")
    nib.save(nib.gifti.GiftiImage(darrays=[nodes, values]), "part.shape.gii")
    sx.write("ball.ply", (BALL.vertices, BALL.faces))
    found = sx.read("ball.ply", maps="part.shape.gii").scalars["part"]
    assert np.isnan(found[30:]).all() and np.array_equal(found[:30], Z[:30].astype(np.float32))
    smooth = sx.smooth(Surface(BALL), "part.shape.gii", 0.1).values
    assert np.isnan(smooth[30:]).all() and np.isfinite(smooth).sum() > 20


def test_labels_and_masks_may_leave_out_the_last_vertices_too(working_folder: Path) -> None:
    nodes = nib.gifti.GiftiDataArray(np.arange(30, dtype=np.int32), "NIFTI_INTENT_NODE_INDEX")
    keys = nib.gifti.GiftiDataArray(np.ones(30, dtype=np.int32), "NIFTI_INTENT_LABEL")
    table = nib.gifti.GiftiLabelTable()
    entry = nib.gifti.GiftiLabel(1, 1.0, 0.0, 0.0, 1.0)
    entry.label = "V1"
    table.labels.append(entry)
    nib.save(nib.gifti.GiftiImage(darrays=[nodes, keys], labeltable=table), "part.label.gii")
    nib.save(nib.gifti.GiftiImage(darrays=[nodes, nib.gifti.GiftiDataArray(np.ones(30, np.float32))]), "part.shape.gii")
    sx.write("ball.ply", (BALL.vertices, BALL.faces))
    for mask in ("part.label.gii", "part.label.gii:V1", "part.shape.gii"):
        found = sx.read("ball.ply", labels={"p": "part.label.gii"}, mask=mask)
        assert found.mask is not None and np.array_equal(found.mask, np.arange(COUNT) < 30)
        assert np.array_equal(found.labels["p"].keys, np.where(np.arange(COUNT) < 30, 1, -1))
    assert sx.parcels(Surface(BALL), Z, "part.label.gii").names == ("V1",)
