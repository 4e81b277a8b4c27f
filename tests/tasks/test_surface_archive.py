"""A surface as .npz comes back whole: maps, mask, labels with colours, unit, hemispheres, space."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.io.surface_archive import RECORD
from surfexp.mesh.both_hemispheres import joined
from surfexp.mesh.coloured_labels import ColouredLabels, coloured_as
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.spatial_frame import CoordinateTransform, SpatialFrame
from surfexp.mesh.surface import Surface

BALL = icosphere(1).mesh
COUNT = len(BALL.vertices)
HEIGHT = BALL.vertices[:, 2]
TABLE = ColouredLabels((HEIGHT > 0).astype(int) * 7, {0: "söuth", 7: "north"}, {7: (0.1, 0.25, 1.0)})
FRAME = SpatialFrame(
    {"cras": np.array([1.5, 0.1, -np.inf]), "volume": np.array([256, 256, 256]), "valid": "1  # volume info valid"},
    (CoordinateTransform("NIFTI_XFORM_UNKNOWN", "NIFTI_XFORM_TALAIRACH", np.diag([1.0, 2.0, 1.0 / 3.0, 1.0])),),
    {"AnatomicalStructurePrimary": "CortexLeft"},
)
FULL = Surface(BALL, "ball", "mm", {"height": HEIGHT}, mask=HEIGHT > -0.5, labels={"parts": TABLE}, frame=FRAME)


def assert_same(found: Surface, given: Surface) -> None:
    assert np.array_equal(found.mesh.vertices, given.mesh.vertices)
    assert np.array_equal(found.mesh.faces, given.mesh.faces)
    assert (found.unit, found.hemisphere) == (given.unit, given.hemisphere)
    for one, other in ((found.mask, given.mask), (found.right, given.right)):
        assert (one is None) == (other is None) and (one is None or np.array_equal(one, other))
    assert list(found.scalars) == list(given.scalars) and list(found.labels) == list(given.labels)
    assert all(np.array_equal(found.scalars[name], given.scalars[name], equal_nan=True) for name in given.scalars)
    for name, table in given.labels.items():
        assert np.array_equal(found.labels[name].keys, table.keys) and found.labels[name].names == dict(table.names)
        assert getattr(found.labels[name], "colors", {}) == getattr(table, "colors", {})
    assert found.frame.metadata == given.frame.metadata and found.frame.volume.keys() == given.frame.volume.keys()
    assert all(np.array_equal(found.frame.volume[key], value) for key, value in given.frame.volume.items())
    for one, other in zip(found.frame.transforms, given.frame.transforms, strict=True):  # type: ignore[assignment]
        assert (one.source, one.target) == (other.source, other.target)  # type: ignore[union-attr]
        assert np.array_equal(one.matrix, other.matrix)  # type: ignore[union-attr]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=40)
@given(data=st.data())
def test_what_is_written_is_read(working_folder: Path, data: st.DataObject) -> None:
    words = st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]), min_size=1, max_size=8)
    names = data.draw(st.dictionaries(st.integers(-3, 2**40), words, max_size=4).filter(_told_apart))
    keys = data.draw(st.lists(st.sampled_from([*names, 99]), min_size=COUNT, max_size=COUNT))
    surface = Surface(
        BALL,
        unit=data.draw(st.text(max_size=3)),
        scalars={"h": np.where(HEIGHT > 0.8, np.nan, HEIGHT)},
        mask=data.draw(st.none() | st.just(HEIGHT > 0)),
        hemisphere=data.draw(st.sampled_from(["", "left", "right"])),
        labels={data.draw(words.filter(lambda word: "/" not in word)): LabelMap(np.array(keys), names)},
        frame=data.draw(st.sampled_from([SpatialFrame(), FRAME])),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sx.write("any.npz", surface)
    # FreeSurfer's space is in millimetres
    assert_same(sx.read("any.npz"), replace(surface, unit=surface.unit or ("mm" if surface.frame.volume else "")))


def _told_apart(names: dict[int, str]) -> bool:
    return len(set(names.values())) == len(names)


def test_both_hemispheres_are_one_file(working_folder: Path) -> None:
    brain = joined(FULL, FULL)
    brain = replace(brain, labels={"parts": coloured_as(brain.labels["parts"], TABLE)})
    sx.write("brain.npz", brain)
    assert [file.name for file in Path().iterdir()] == ["brain.npz"]
    found = sx.read("brain.npz")
    assert_same(found, brain)
    assert np.array_equal(sx.eigenpairs(found, 4).values, sx.eigenpairs(brain, 4).values)
    with pytest.raises(ValueError, match=r"brain.npz holds both hemispheres, one file or hemisphere= says left: give"):
        sx.read("brain.npz", hemisphere="left")
    with pytest.raises(ValueError, match=r"brain.npz holds both hemispheres"):
        sx.read(left="brain.npz", right="brain.npz")
    assert_same(sx.repair(found), brain)


def test_commands_take_it_and_make_it(working_folder: Path) -> None:
    sx.write("brain.npz", joined(FULL, FULL))
    assert main(["convert", "brain.npz", "again.npz"]) == 0
    assert_same(sx.read("again.npz"), joined(FULL, FULL))
    assert main(["smooth", "again.npz", "height", "--width", ".3", "--to", "smooth.npz"]) == 0
    assert len(np.load("smooth.npz")["hemisphere"]) == 2 * COUNT
    assert main(["convert", "brain.npz", "apart.ply"]) == 0
    assert sorted(file.name for file in Path().glob("*apart.ply")) == ["lh.apart.ply", "rh.apart.ply"]


def test_numpy_alone_reads_what_matters_and_its_maps_are_maps(working_folder: Path) -> None:
    sx.write("ball.npz", FULL)
    with np.load("ball.npz", allow_pickle=False) as found:
        assert np.array_equal(found["height"], HEIGHT) and np.array_equal(found["surface.mask"], HEIGHT > -0.5)
    sx.write("bare.ply", (BALL.vertices, BALL.faces))
    assert list(sx.read("bare.ply", maps="ball.npz").scalars) == ["ball"]


def test_what_is_given_replaces_what_is_held(working_folder: Path) -> None:
    sx.write("ball.npz", FULL)
    found = sx.read("ball.npz", mask=HEIGHT < 0, unit="m")
    assert found.unit == "m" and found.mask is not None and found.mask.sum() == (HEIGHT < 0).sum()


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"surface.mask": np.ones(3, bool)}, "'surface.mask' has shape"),
        ({"surface.mask": HEIGHT}, "'surface.mask' has shape .* and type float64"),
        ({"surface.labels.parts": np.array([["a"]])}, "'surface.labels.parts' has shape"),
        ({RECORD: np.array('{"labels": {"lost": {"names": {}}}}')}, "'lost' have names and no array"),
        ({RECORD: np.array('{"unit": 3}')}, "its unit is 3, a word is needed"),
        ({RECORD: np.array('{"labels": {"parts": {"names": {"a": "b"}}}}')}, "invalid literal"),
        (
            {RECORD: np.array('{"labels": {"parts": {"names": {}, "colors": {"1": [0, 0, 2]}}}}')},
            "the colour .0, 0, 2.",
        ),
        ({RECORD: np.array('{"labels": []}')}, "its labels is no mapping"),
        ({RECORD: np.array('{"transforms": [["", "", [[1]]]]}')}, r"\(1, 1\)"),
        ({RECORD: np.array('{"transforms": [1]}')}, "does not fit together"),
        ({RECORD: np.array('{"volume": {"cras": [[1]]}}')}, "'cras' is no list of numbers"),
        ({RECORD: np.array("{")}, "property name"),
        ({RECORD: np.array("3")}, "its record is no mapping"),
        ({"hemisphere": np.array(["left", "right"])}, "'left' or 'right' is needed for each of 42 vertices"),
        ({"hemisphere": np.full(COUNT, "up")}, "'left' or 'right' is needed"),
    ],
)
def test_broken_archives_are_refused_in_one_line(
    working_folder: Path, changed: dict[str, np.ndarray], said: str
) -> None:
    sx.write("ball.npz", FULL)
    with np.load("ball.npz") as held:
        np.savez("broken.npz", **({name: held[name] for name in held.files} | changed))
    with pytest.raises(ValueError, match=f"^broken.npz cannot be read as a mesh: .*{said}") as caught:
        sx.read("broken.npz")
    assert "\n" not in str(caught.value)


def test_a_map_cannot_have_the_name_of_another_part(working_folder: Path) -> None:
    for name in ("vertices", "surface.mask"):
        with pytest.raises(ValueError, match=f"a map is called '{name}'"):
            sx.write("ball.npz", Surface(BALL, scalars={name: HEIGHT}))
