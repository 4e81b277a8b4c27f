"""Labels that are handed over, of one surface or by hemisphere: names meet, and colours of their own stay."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.both_hemispheres import joined
from surfexp.mesh.coloured_labels import ColouredLabels
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.tasks.drawn_labels import drawn_labels, maps_apart
from surfexp.tasks.given_labels import labels_on

RED, BLUE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
BALL = icosphere(1).mesh
COUNT = len(BALL.vertices)
ONE = Surface(BALL, hemisphere="left")
BOTH = joined(ONE, Surface(BALL, hemisphere="right"))
# one name on both sides, under other numbers
LEFT = ColouredLabels(np.arange(COUNT) % 2 + 1, {1: "V1", 2: "insula"}, {1: RED, 2: BLUE})
RIGHT = ColouredLabels(np.arange(COUNT) % 2 + 1, {1: "insula", 2: "cuneus"}, {1: RED})


def _colors(owner: Surface, given: Any) -> dict[str, tuple[float, ...]]:
    drawn = drawn_labels(owner, given)
    assert drawn is not None
    return {name: tuple(color) for name, color in zip(drawn.names, drawn.colors.tolist(), strict=True)}


@pytest.mark.parametrize(
    ("owner", "given"), [(ONE, LEFT), (ONE, {"left": LEFT}), (BOTH, {"left": LEFT, "right": RIGHT})]
)
def test_labels_keep_the_colours_that_they_came_with(owner: Surface, given: Any) -> None:
    found = labels_on(owner, given)
    assert isinstance(found, ColouredLabels) and found.by_name == {"V1": RED, "insula": BLUE}
    colors = _colors(owner, given)
    assert colors["V1"] == RED and colors["insula"] == BLUE


def test_each_hemisphere_is_drawn_in_the_colours_of_both() -> None:
    left, right = maps_apart([BOTH], [{"left": LEFT, "right": RIGHT}])
    of_right = _colors(BOTH.hemispheres()["right"], right)
    assert of_right["insula"] == _colors(BOTH.hemispheres()["left"], left)["insula"] == BLUE
    assert of_right["cuneus"] not in (RED, BLUE)


def test_what_has_one_name_on_both_sides_is_one_label() -> None:
    found = labels_on(BOTH, {"left": LEFT, "right": RIGHT})
    named = np.array([found.names[key] for key in found.keys.tolist()])
    assert named[:COUNT].tolist() == ["V1", "insula"] * (COUNT // 2)
    assert named[COUNT:].tolist() == ["insula", "cuneus"] * (COUNT // 2)
    assert not isinstance(
        labels_on(BOTH, {"left": LabelMap(LEFT.keys, LEFT.names), "right": RIGHT.keys}), ColouredLabels
    )


def test_labels_are_given_by_their_file(working_folder: Path) -> None:
    table = LabelMap(np.arange(COUNT) % 2, {0: "a", 1: "b"})
    sx.write("lh.p.annot", table)
    sx.write("rh.p.annot", table)
    wanted = sx.parcels(BALL, BALL.vertices[:, 2], table).means
    assert np.array_equal(sx.parcels(BALL, BALL.vertices[:, 2], "lh.p.annot").means, wanted)
    assert np.array_equal(sx.parcels(BALL, BALL.vertices[:, 2], Path("lh.p.annot")).means, wanted)
    both = sx.parcels(BOTH, np.tile(BALL.vertices[:, 2], 2), {"left": "lh.p.annot", "right": "rh.p.annot"})
    assert both.names == ("a", "b", "a", "b")
    with pytest.raises(
        ValueError, match=r"labels are 'none.annot': there is no such file, and surface 'surface' carries no labels"
    ):
        sx.parcels(BALL, BALL.vertices[:, 2], "none.annot")


def test_masked_names_are_none() -> None:
    names = np.ma.masked_array(np.array(["a", "b"] * (COUNT // 2)), mask=[False, True] * (COUNT // 2))
    assert sx.parcels(BALL, BALL.vertices[:, 2], names).names == ("a",)


def test_further_maps_of_labels_are_said_to_be_passed_over(working_folder: Path) -> None:
    import nibabel as nib

    sx.write("p.label.gii", LabelMap(np.arange(COUNT) % 2, {0: "a", 1: "b"}))
    image = nib.load("p.label.gii")
    image.darrays.append(image.darrays[0])
    image.darrays[0].meta = nib.gifti.GiftiMetaData({"Name": "Yeo"})
    nib.save(image, "two.label.gii")
    sx.write("ball.ply", (BALL.vertices, BALL.faces))
    notes = sx.read("ball.ply", labels="two.label.gii").notes
    assert notes == ("two.label.gii has 2 maps of labels, 'Yeo', 'Yeo 2': the first is taken.",)
    assert sx.read("ball.ply", labels="p.label.gii").notes == ()


def test_a_map_in_the_place_of_the_surface_is_told(working_folder: Path) -> None:
    sx.write("lh.thickness", BALL.vertices[:, 2])
    with pytest.raises(
        ValueError, match=f"lh.thickness .* it is a map of FreeSurfer's for {COUNT} vertices: give the surface"
    ):
        sx.read("lh.thickness")


def test_a_name_of_two_labels_is_refused() -> None:
    with pytest.raises(ValueError, match="the name 'a' stands for two labels, each needs its own"):
        LabelMap(np.arange(COUNT) % 3, {0: "a", 1: "b", 2: "a"})
