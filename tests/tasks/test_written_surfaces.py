"""What a format cannot hold of a surface is said where it is written."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.tasks.written_targets import check_target
from tests.tasks.test_stored_surface import VOLUME

BALL = icosphere(2).mesh
FORMATS = ["a.npz", "a.ply", "a.vtk", "a.vtp", "a.off", "a.obj", "a.stl", "a.surf.gii", "lh.white"]


def said(*given: Any) -> list[str]:
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        sx.write(*given)
    return [str(one.message) for one in found]


def test_a_file_that_cannot_hold_maps_is_refused_before_anything_is_computed(tmp_path: Path) -> None:
    check_target(tmp_path / "map.npy")
    with pytest.raises(ValueError, match=r"map\.xyz"):
        check_target(tmp_path / "map.xyz")
    with pytest.raises(ValueError, match="nowhere"):
        check_target(tmp_path / "nowhere" / "map.npy")


@pytest.mark.parametrize("volume", [{}, VOLUME])
@pytest.mark.parametrize("side", ["", "left"])
@pytest.mark.parametrize("unit", ["mm", "um", "nm"])
@pytest.mark.parametrize("name", FORMATS)
def test_a_unit_comes_back_or_is_said(working_folder: Path, name: str, unit: str, side: str, volume: dict) -> None:
    frame = replace(Surface(BALL).frame, volume=volume)
    notes = said(name, Surface(BALL, unit=unit, hemisphere=side, frame=frame))
    read = sx.read(name).unit
    about = [note for note in notes if f"unit ({unit})" in note or f"unit='{unit}'" in note]
    assert (read == unit) == (not about) and len(about) < 2
    if read and about:
        assert about == [f"{name} is read in mm, the surface is in {unit}: give unit='{unit}' where it is read."]
    assert sx.read(name, unit=unit).unit == unit


def test_the_unit_is_no_part_of_maps_beside_a_surface(working_folder: Path) -> None:
    assert said("a.vtp", BALL.vertices[:, 2], Surface(BALL, unit="nm")) == []


def test_stl_says_that_vertices_get_other_numbers(working_folder: Path) -> None:
    assert said("a.stl", BALL) == [
        "a.stl holds no numbers of vertices: maps of the surface do not fit what is read from it."
    ]
    assert not np.array_equal(sx.read("a.stl").vertices, BALL.vertices.astype(np.float32))


@pytest.mark.parametrize("name", ["a.surf.gii", "lh.white", "a.stl"])
@pytest.mark.parametrize("offset", [0.0, 1e3, 1e5, 1e6])
def test_edges_that_single_precision_changes_are_said(working_folder: Path, name: str, offset: float) -> None:
    far = TriangleMesh(BALL.vertices + offset, BALL.faces)
    notes = [note for note in said(name, far) if "single precision" in note]
    rounded = far.vertices.astype(np.float32).astype(float)
    starts, ends = BALL.edges.T
    change = np.linalg.norm((rounded - far.vertices)[ends] - (rounded - far.vertices)[starts], axis=1)
    largest = (change / np.linalg.norm(far.vertices[ends] - far.vertices[starts], axis=1)).max()
    assert bool(notes) == (largest > 1e-3) == (offset >= 1e4)
    assert not notes or f"up to {largest:.1%} of their length" in notes[0]


def test_an_swc_file_names_its_unit(working_folder: Path) -> None:
    body = sx.shape("ellipsoid", levels=2)
    graph = sx.reeb_graph(body, body.vertices[:, 2], count=5)
    assert said("a.swc", graph, replace(body, unit="um")) == []
    assert "# unit of length: um\n" in Path("a.swc").read_text()
    assert said("b.swc", graph) == [
        "b.swc is read in micrometres, the unit of the surface is not known: its lengths are as they are there."
    ]
    rows = [[line for line in Path(name).read_text().splitlines() if line[0] != "#"] for name in ("a.swc", "b.swc")]
    assert rows[0] == rows[1]
