"""Maps by parcels: means of known integrals, weights by area, NaN, masks, and the way back to the surface."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfexp as sx
from surfexp.io.map_files import read_maps
from surfexp.mesh.both_hemispheres import joined
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.drawn_results import NULLS
from surfexp.tasks.parcellation import weighted_median

BALL = sx.shape("icosphere", levels=5).mesh
# along no axis of the mesh, on which whole rows of vertices would lie at a border
HEIGHT = BALL.vertices @ [0.48, 0.36, 0.8]
BANDS = LabelMap(np.digitize(HEIGHT, [-0.5, 0.0, 0.5]), {0: "a", 1: "b", 2: "c", 3: "d"})


def test_bands_of_a_sphere_have_the_means_and_areas_of_archimedes() -> None:
    """Between two heights a sphere has the area of its cylinder, and all heights alike."""
    found = sx.parcels(BALL, HEIGHT, BANDS)
    assert found.names == ("a", "b", "c", "d") and found.hemispheres == ("",) * 4
    np.testing.assert_allclose(found.areas, np.pi, rtol=0.02)
    np.testing.assert_allclose(found.means, [-0.75, -0.25, 0.25, 0.75], atol=5e-3)
    np.testing.assert_allclose(found.medians, [-0.75, -0.25, 0.25, 0.75], atol=1e-2)
    assert found.areas.sum() == pytest.approx(BALL.area) and found.vertices.sum() == len(HEIGHT)


def test_vertices_count_by_their_area() -> None:
    """A flat square whose left half is cut finely: the plain mean would lean to the left."""
    x = np.concatenate([np.linspace(0.0, 0.5, 40), np.linspace(0.5, 1.0, 4)[1:]])
    grid = np.stack(np.meshgrid(x, np.linspace(0.0, 1.0, 9), indexing="ij"), axis=-1).reshape(-1, 2)
    a = (np.arange(len(x) - 1)[:, None] * 9 + np.arange(8)).ravel()
    faces = np.concatenate([np.stack([a, a + 9, a + 10], 1), np.stack([a, a + 10, a + 1], 1)])
    square = TriangleMesh(np.column_stack([grid, np.zeros(len(grid))]), faces)
    found = sx.parcels(square, grid[:, 0], np.ones(len(grid), int))
    assert found.means[0] == pytest.approx(0.5, abs=1e-12) and grid[:, 0].mean() < 0.35
    assert abs(found.medians[0] - 0.5) < 0.1
    # of the last three columns, a third of a half wide, the area is that from half a column on
    half = sx.parcels(square, np.where(grid[:, 0] > 0.51, np.nan, 1.0), np.ones(len(grid), int))
    assert half.unknown[0] == pytest.approx(5.0 / 12.0, abs=1e-12)


def test_unknown_values_are_a_share_of_the_area_and_do_not_count() -> None:
    holed = np.where(HEIGHT > 0.75, np.nan, HEIGHT)
    holed[HEIGHT < -0.5] = np.nan
    found = sx.parcels(BALL, holed, BANDS)
    np.testing.assert_allclose(found.unknown, [1.0, 0.0, 0.0, 0.5], atol=0.02)
    assert np.isnan([found.means[0], found.medians[0]]).all()
    assert found.means[3] == pytest.approx(0.625, abs=5e-3) and found.areas[3] == pytest.approx(np.pi, rel=0.02)


def test_the_mask_and_labels_without_a_parcel_are_outside() -> None:
    names = {0: "unknown", 1: "b", 3: "d", 7: "nowhere"}
    found = sx.parcels(Surface(BALL, mask=HEIGHT < 0.8), HEIGHT, LabelMap(BANDS.keys, names))
    assert found.names == ("b", "d") and (found.rows[BANDS.keys == 2] == -1).all()
    corners = BALL.faces[(HEIGHT[BALL.faces] < 0.8).all(axis=1)]
    a, b, c = (BALL.vertices[corner] for corner in corners.T)
    thirds = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6.0
    assert found.areas[1] == pytest.approx(thirds @ (BANDS.keys[corners] == 3).sum(axis=1), rel=1e-12)
    assert any("'unknown'" in note for note in found.notes) and any("nowhere" in note for note in found.notes)
    assert np.isnan(found.values[HEIGHT > 0.8]).all()


def test_maps_of_subjects_are_channels_as_one_by_one() -> None:
    maps = np.random.default_rng(0).standard_normal((len(HEIGHT), 3))
    maps[5, 1] = np.nan
    found = sx.parcels(BALL, maps, BANDS)
    for k, one in enumerate(maps.T):
        alone = sx.parcels(BALL, one, BANDS)
        for name in ("means", "medians", "unknown"):
            np.testing.assert_array_equal(getattr(found, name)[:, k], getattr(alone, name))
    table = found.table()
    assert list(table)[:3] == ["parcel", "vertices", "area"] and table["mean 2"] == found.means[:, 2].tolist()


def test_numbers_of_parcels_are_a_map_again() -> None:
    found = sx.parcels(BALL, HEIGHT, BANDS)
    np.testing.assert_array_equal(found.on_surface(np.arange(4)), BANDS.keys)
    np.testing.assert_array_equal(found.values, found.means[BANDS.keys])
    np.testing.assert_allclose(sx.parcels(BALL, found.values, BANDS).means, found.means, rtol=1e-12)
    with pytest.raises(ValueError, match="there are 4 parcels"):
        found.on_surface([1.0])


def test_both_hemispheres_have_rows_of_their_own() -> None:
    left, right = Surface(BALL, hemisphere="left"), Surface(BALL, hemisphere="right")
    brain = joined(left, right)
    keys = np.concatenate([BANDS.keys, np.where(BANDS.keys == 3, 9, BANDS.keys)])
    names = {**BANDS.names, 9: "right only"}
    found = sx.parcels(brain, np.concatenate([HEIGHT, 2.0 * HEIGHT]), LabelMap(keys, names))
    table = found.table()
    assert list(zip(table["hemisphere"], table["parcel"], strict=True)) == [
        *(("left", name) for name in "abcd"),
        *(("right", name) for name in ("a", "b", "c", "right only")),
    ]
    np.testing.assert_allclose(found.means[4:], 2.0 * found.means[:4], rtol=1e-12)
    assert sx.parcels(left, HEIGHT, BANDS).hemispheres == ("left",) * 4


@pytest.mark.parametrize(
    ("values", "labels", "line"),
    [
        (HEIGHT, "aparc", "labels are 'aparc': there is no such file"),
        (HEIGHT, BANDS.keys[1:], "labels have shape \\(10241,\\), the surface has 10242 vertices"),
        (HEIGHT, np.zeros(len(HEIGHT), int), "no vertex of 10242 is in a parcel"),
        (HEIGHT, HEIGHT, "whole numbers are needed"),
        (HEIGHT[1:], BANDS, "map has shape"),
    ],
)
def test_what_does_not_fit_is_refused(values: np.ndarray, labels: object, line: str) -> None:
    with pytest.raises(ValueError, match=line):
        sx.parcels(BALL, values, labels)  # type: ignore[arg-type]


@given(st.lists(st.tuples(st.integers(-5, 5), st.sampled_from([0.25, 0.5, 1.0, 2.0])), min_size=1, max_size=12))
@settings(max_examples=200)
def test_the_median_is_that_of_copies(pairs: list[tuple[int, float]]) -> None:
    values, weights = np.array([v for v, _ in pairs], dtype=float), np.array([w for _, w in pairs])
    copies = np.repeat(values, (4 * weights).astype(int))
    assert weighted_median(values, weights) == np.median(copies)


def test_vertices_whose_label_has_no_name_are_told() -> None:
    nameless = LabelMap(np.where(HEIGHT > 0.5, 9, BANDS.keys), BANDS.names)
    found = sx.parcels(BALL, HEIGHT, nameless)
    assert f"Left out: {(HEIGHT > 0.5).sum()} vertices whose label has no name." in found.notes
    assert not any("no name" in note for note in sx.parcels(BALL, HEIGHT, BANDS).notes)


@pytest.mark.parametrize("size", [10, 38, 40000])
@pytest.mark.parametrize("weight", [0.1, 1.0 / 3.0, 1e-7])
def test_equal_weights_are_the_plain_median_whatever_they_round_to(size: int, weight: float) -> None:
    """Ten times .1 was less than 1, so that half of it was met one place early."""
    values = np.random.default_rng(size).permutation(np.arange(float(size)))
    assert weighted_median(values, np.full(size, weight)) == np.median(values) == 0.5 * (size - 1)


def test_a_picture_shows_the_means() -> None:
    pytest.importorskip("matplotlib")
    picture = sx.parcels(BALL, HEIGHT, BANDS).plot(BALL, width=300)
    np.testing.assert_array_equal(picture.views[0][0].values, sx.parcels(BALL, HEIGHT, BANDS).values)
    several = sx.parcels(BALL, np.stack([HEIGHT] * 6, 1), BANDS).plot(BALL, width=300)
    assert sum(map(len, several.views)) == NULLS


HALVES = np.where(HEIGHT > 0, 2, 1)
WORDS = np.where(HALVES == 1, "south", "north").astype(object)


@pytest.mark.parametrize(
    "labels",
    [
        HALVES.astype(float),
        HALVES.astype(object),
        WORDS,
        WORDS.astype("U"),
        pd.Categorical(WORDS),
        pd.Series(WORDS, index=np.arange(len(WORDS))[::-1]),
        WORDS.tolist(),
    ],
)
def test_labels_are_numbers_or_names(labels: object) -> None:
    wanted, found = sx.parcels(BALL, HEIGHT, HALVES), sx.parcels(BALL, HEIGHT, labels)
    south = found.names.index("south" if "south" in found.names else "1")
    assert [found.means[south], found.means[1 - south]] == wanted.means.tolist()


@pytest.mark.parametrize(
    "labels",
    [
        np.where(HALVES == 1, np.nan, HALVES),
        np.ma.masked_array(HALVES, HALVES == 1),
        np.where(HALVES == 1, None, HALVES),
        np.where(HALVES == 1, None, WORDS),
        np.where(HALVES == 1, np.nan, WORDS),
        np.where(HALVES == 1, "", WORDS),
        np.where(HALVES == 1, "unknown", WORDS),
    ],
)
def test_what_has_no_label_is_in_no_parcel(labels: object) -> None:
    found = sx.parcels(BALL, HEIGHT, labels)
    assert found.names in (("2",), ("north",)) and found.means[0] == sx.parcels(BALL, HEIGHT, HALVES).means[1]


def test_parcels_are_a_table_in_text_and_a_map_elsewhere(working_folder: Path) -> None:
    found = sx.parcels(BALL, HEIGHT, BANDS)
    sx.write("means.csv", found)
    table = pd.read_csv("means.csv")
    assert table.columns.tolist() == list(found.table()) and np.array_equal(table["mean"], found.means)
    sx.write("means.npz", found)
    assert np.array_equal(*read_maps("means.npz").values(), found.values)
