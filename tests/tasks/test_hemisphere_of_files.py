"""The hemisphere of a file: by its name, by what the caller says, and in the metadata that is written."""

from __future__ import annotations

import nibabel
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.io.hemisphere import hemisphere_of_file
from surfexp.mesh.spatial_frame import SpatialFrame
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

BALL = sx.shape("icosphere", levels=2).mesh


@pytest.mark.parametrize(
    ("name", "said", "side"),
    [("lh.ball.off", "", "left"), ("rh.ball.off", "", "right"), ("ball.off", "right", "right"), ("ball.off", "", "")],
)
def test_the_name_or_the_caller_says_the_side(working_folder, name: str, said: str, side: str) -> None:
    sx.write(name, Surface(BALL))
    assert sx.read(name, hemisphere=said).hemisphere == side


@pytest.mark.parametrize(("side", "structure"), [("left", "CortexLeft"), ("right", "CortexRight"), ("", None)])
def test_gifti_carries_the_side_of_surfaces_and_maps(working_folder, side: str, structure: str | None) -> None:
    surface = Surface(BALL, scalars={"height": BALL.vertices[:, 2]}, hemisphere=side)
    sx.write("ball.surf.gii", surface)
    image = nibabel.load("ball.surf.gii")
    stated = {array.meta.get("AnatomicalStructurePrimary") for array in image.darrays[:1]}
    assert stated == {structure}
    assert sx.read("ball.surf.gii").hemisphere == side
    sx.write("height.shape.gii", sx.smooth(surface, "height", 1.0), surface)
    assert nibabel.load("height.shape.gii").meta.get("AnatomicalStructurePrimary") == structure


def test_repair_keeps_side_and_space(working_folder) -> None:
    frame = SpatialFrame(metadata={"GeometricType": "Anatomical"})
    sx.write("broken.surf.gii", Surface(TriangleMesh(BALL.vertices, BALL.faces[:-1]), hemisphere="left", frame=frame))
    assert main(["repair", "broken.surf.gii", "--to", "mended.surf.gii"]) == 0
    mended = sx.read("mended.surf.gii")
    assert mended.hemisphere == "left" and mended.frame.metadata["GeometricType"] == "Anatomical"


@pytest.mark.parametrize("side", ["left", "right", ""])
def test_labels_say_their_side_and_are_refused_on_the_other(working_folder, side: str) -> None:
    surface = Surface(BALL, hemisphere=side)
    sx.write("parts.label.gii", sx.segment(surface, BALL.vertices[:, 2]), surface)
    assert hemisphere_of_file("parts.label.gii") == side
    sx.write("rh.ball.off", Surface(BALL))
    if side == "left":
        with pytest.raises(ValueError, match="left"):
            sx.read("rh.ball.off", labels={"parts": "parts.label.gii"})
    else:
        assert sx.read("rh.ball.off", labels={"parts": "parts.label.gii"}).labels
