"""What a file is named as, it is: a map is not written as labels, nor under the name of another format."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import surfexp as sx
from surfexp.io.label_files import read_label_map
from surfexp.io.map_files import read_maps
from surfexp.mesh.shapes.icosphere import icosphere

BALL = icosphere(1).mesh
COUNT = len(BALL.vertices)
HEIGHT = BALL.vertices[:, 2]
NUMBERS = np.arange(COUNT) % 3
NAMES = np.array(["", "V1", "V2"])[NUMBERS]
FOREIGN = ["annot", "label", "nii", "nii.gz", "asc", "mat", "tsv", "vtu", "json", "h5", "png", "parquet", "pial"]


@pytest.mark.parametrize("suffix", [*FOREIGN, "label.gii", "dlabel.nii", "dtseries.nii", "pscalar.nii", "surf.gii"])
@pytest.mark.parametrize("start", ["", "lh."])
def test_a_map_is_written_as_a_map_or_refused(working_folder: Path, start: str, suffix: str) -> None:
    name = f"{start}{suffix}" if suffix == "pial" else f"{start}q.{suffix}"
    with pytest.raises(ValueError, match=r"^[^\n]+$"):
        sx.write(name, HEIGHT)
    assert not Path(name).exists()


@pytest.mark.parametrize("name", ["lh.sulc", "lh.thickness.fsaverage", "lh.curv.pial", "lh.w-g.pct", "rh_area"])
def test_names_of_freesurfer_are_its_own(working_folder: Path, name: str) -> None:
    sx.write(name, HEIGHT)
    assert np.allclose(next(iter(read_maps(name).values())), HEIGHT, atol=1e-7)


@pytest.mark.parametrize("given", [NUMBERS, NUMBERS.astype(float), NAMES, NAMES.astype(object), pd.Series(NAMES)])
@pytest.mark.parametrize("name", ["p.label.gii", "lh.p.annot"])
def test_whole_numbers_and_names_are_labels(working_folder: Path, name: str, given: object) -> None:
    sx.write(name, given)
    found = read_label_map(name)
    words = [found.names.get(key, "") for key in found.keys.tolist()]
    assert words == (NAMES.tolist() if np.asarray(given).dtype.kind in "UO" else ["", "1", "2"] * (COUNT // 3))


def test_files_of_labels_take_no_real_numbers(working_folder: Path) -> None:
    for name in ("q.label.gii", "lh.q.annot"):
        with pytest.raises(ValueError, match="whole number"):
            sx.write(name, HEIGHT)


@pytest.mark.parametrize("missing", [None, np.nan, pd.NA, pd.NaT])
def test_what_is_missing_in_a_table_is_no_label(missing: object) -> None:
    given = np.array([missing, "a"] * (COUNT // 2), dtype=object)
    assert sx.parcels(BALL, HEIGHT, given).names == ("a",)
    assert sx.parcels(BALL, HEIGHT, pd.Series(given).astype("string")).names == ("a",)


def test_equal_eigenvalues_are_said_to_decide_about_a_distance() -> None:
    turned = np.random.default_rng(0).permutation(COUNT)
    found = sx.distance(BALL, (BALL.vertices[turned], np.argsort(turned)[BALL.faces]), n=8)
    assert any(note.startswith("Modes 1 to 3, 4 to 8 have equal eigenvalues") for note in found.notes)
    simple = sx.shape("ellipsoid", levels=2)
    assert not any("equal eigenvalues" in note for note in sx.distance(simple, simple, n=4).notes)


def test_two_components_warn_of_nothing() -> None:
    two = (np.r_[BALL.vertices, BALL.vertices + 5.0], np.r_[BALL.faces, BALL.faces + COUNT])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        distance, lower = sx.geodesic(two, 0, bounds=True)
    assert np.isinf(distance[COUNT:]).all() and np.isinf(lower[COUNT:]).all()
