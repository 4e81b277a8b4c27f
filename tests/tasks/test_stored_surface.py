"""A file gives one surface, whether it is read, repaired or checked."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main
from surfexp.mesh.both_hemispheres import joined
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from tests.tasks.test_surface_archive import BALL, COUNT, FULL, assert_same

VOLUME = {
    "head": np.array([2, 0, 20]),
    "valid": "1  # volume info valid",
    "filename": "brain.mgz",
    "volume": np.array([256, 256, 256]),
    "voxelsize": np.ones(3),
    "xras": np.array([-1.0, 0.0, 0.0]),
    "yras": np.array([0.0, 0.0, -1.0]),
    "zras": np.array([0.0, 1.0, 0.0]),
    "cras": np.zeros(3),
}
FULL = replace(FULL, frame=replace(FULL.frame, volume=VOLUME))
BRAIN = joined(replace(FULL, hemisphere="left"), replace(FULL, hemisphere="right"))


def turned(surface: Surface) -> Surface:
    faces = surface.mesh.faces.copy()
    faces[:3] = faces[:3, ::-1]
    return replace(surface, mesh=TriangleMesh(surface.mesh.vertices, faces))


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["one.npz", "both.npz", "lh.white", "left.surf.gii", "rh.one.ply", "one.vtp"])
def test_a_repair_has_what_reading_has(working_folder: Path, name: str) -> None:
    side = {"b": "both", "r": "right", "l": "left"}.get(name[0], "")
    given = BRAIN if side == "both" else replace(FULL, hemisphere=side)
    sx.write(name, given)
    sx.write(f"bad.{name}", turned(given))
    read = sx.read(name)
    assert_same(sx.repair(name), read)
    assert read.unit == ("" if name in ("rh.one.ply", "one.vtp") else "mm")
    found, by_reading = sx.repair(f"bad.{name}"), sx.read(f"bad.{name}", repair=True)
    assert_same(found, by_reading)
    assert found.notes == by_reading.notes and len(found.notes) == 1 and sx.check(found).ok
    assert_same(replace(found, mesh=read.mesh), read)


def test_both_hemispheres_of_a_file_are_repaired_and_judged_apart(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    sx.write("both.npz", BRAIN)
    assert sx.check("both.npz").ok and sx.check("both.npz").lines() == sx.check(BRAIN).lines()
    assert_same(sx.repair("both.npz", largest_component=True), BRAIN)
    assert main(["check", "both.npz"]) == 0
    assert main(["repair", "both.npz", "--largest-component", "--to", "same.npz"]) == 0
    assert_same(sx.read("same.npz"), BRAIN)
    assert main(["repair", "both.npz", "--to", "apart.ply"]) == 0
    assert "lh.apart.ply and rh.apart.ply: 84 vertices" in capsys.readouterr().out
    assert json.loads(Path("apart.ply.json").read_text())["changes"] == 0
    assert main(["repair", "both.npz", "--hemisphere", "left", "--to", "left.npz"]) == 2
    assert "hemisphere left names one side, both.npz is both" in capsys.readouterr().err


def test_a_map_with_infinite_values_does_not_keep_a_mesh_from_being_read(working_folder: Path) -> None:
    sx.write("ball.ply", Surface(BALL, scalars={"height": BALL.vertices[:, 2], "depth": np.arange(COUNT) + 0.123}))
    content = Path("ball.ply").read_bytes()
    Path("ball.ply").write_bytes(content.replace(np.float64(0.123).tobytes(), np.float64(np.inf).tobytes()))
    note = f"ball.ply: map 'depth' has 1 infinite values of {COUNT}: it is left out; NaN stands for what is not known."
    for found in (sx.read("ball.ply"), sx.repair("ball.ply")):
        assert list(found.scalars) == ["height"] and found.notes == (note,)
    assert sx.check("ball.ply").ok


def test_labels_follow_their_vertices_out_of_a_file(working_folder: Path) -> None:
    twice = np.r_[BALL.vertices, BALL.vertices[:1]], np.r_[BALL.faces[1:], np.where(BALL.faces[:1] == 0, COUNT, 0)]
    sx.write("loose.npz", Surface(TriangleMesh(*twice), labels={"a": LabelMap(np.arange(COUNT + 1), {COUNT: "last"})}))
    found = sx.repair("loose.npz", renumber=True)
    assert len(found.labels["a"].keys) == len(found.mesh.vertices)
