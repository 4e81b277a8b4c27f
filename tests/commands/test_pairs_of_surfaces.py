"""`surfexp distance` and `align` of repaired surfaces: rows and numbers are those of the files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.command_line import main

BODY = sx.shape("ellipsoid", levels=2, semiaxes=(1.0, 1.3, 1.9))
N = len(BODY.vertices)
TIP = int(np.argmax(BODY.vertices[:, 2]))


def touching() -> tuple[np.ndarray, np.ndarray]:
    """The body, a small tetrahedron that touches it in a vertex, and a vertex without faces in front."""
    tip = BODY.vertices[TIP]
    more = tip + 0.2 * np.array([[1.0, 0.0, 1.0], [-0.5, 0.8, 1.0], [-0.5, -0.8, 1.0]])
    faces = np.r_[BODY.faces, np.array([[TIP, N, N + 1], [TIP, N + 1, N + 2], [TIP, N + 2, N], [N, N + 2, N + 1]])]
    return np.r_[[[9.0, 9.0, 9.0]], BODY.vertices, more], faces + 1


def cut_open() -> tuple[np.ndarray, np.ndarray]:
    """The body with a face of its own corners, which repair merges, behind all others."""
    faces = BODY.faces.copy()
    faces[0] = np.arange(N, N + 3)
    return np.r_[BODY.vertices, BODY.vertices[BODY.faces[0]]], faces


@pytest.fixture
def folder(working_folder: Path) -> Path:
    sx.write("good.npz", BODY)
    sx.write("cut.npz", cut_open())
    return working_folder


def test_rows_of_a_map_are_those_of_the_file(folder: Path) -> None:
    assert main(["distance", "good.npz", "cut.npz", "-n", "3", "--repair", "--to", "map.npz"]) == 0
    kept, said = np.load("map.npz")["correspondence"], json.loads(Path("map.npz.json").read_text())
    assert len(kept) == N + 3 and (kept >= 0).all() and (kept < N).all()
    # a copy that was merged has the value of the vertex it became
    assert np.array_equal(kept[N:], kept[BODY.faces[0]])
    assert said["options"]["repair"] and any(note.startswith("cut.npz: merged") for note in said["notes"])


def test_few_vertices_stand_for_the_others_and_it_is_said(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sx.write("long.npz", sx.shape("ellipsoid", levels=2, semiaxes=(1.0, 1.3, 2.5)))
    assert main(["distance", "good.npz", "long.npz", "-n", "3", "--points", "60"]) == 0
    said = capsys.readouterr()
    assert "(not proved, at least " in said.out
    assert f"of {N} vertices stand for the others" in said.err and "symmetries were not looked for" in said.err
    assert main(["distance", "good.npz", "good.npz", "-n", "3", "--points", "60", "--to", "map.npz"]) == 0
    kept = json.loads(Path("map.npz.json").read_text())
    assert kept["options"]["points"] == 60 and kept["value"] < 1e-9
    assert np.array_equal(np.load("map.npz")["correspondence"], np.arange(N))


def test_aligned_modes_have_a_row_for_each_vertex_of_the_file(folder: Path) -> None:
    assert main(["align", "good.npz", "cut.npz", "-k", "3", "--repair", "--to", "modes.npz"]) == 0
    kept, said = np.load("modes.npz"), json.loads(Path("modes.npz.json").read_text())
    assert kept["vectors"].shape == (N + 3, 3) and kept["basis"].shape == (3, 3)
    assert np.array_equal(kept["vectors"][N:], kept["vectors"][BODY.faces[0]])
    assert any(note.startswith("cut.npz: merged") for note in said["notes"])
    found = sx.align(sx.read("good.npz"), sx.read("cut.npz", repair=True), 3)
    sx.write("own.npz", found, sx.read("cut.npz", repair=True))
    own = np.load("own.npz")
    assert set(own) >= {"vectors", "basis"}
    assert all(np.array_equal(own[name], kept[name]) for name in ("vectors", "basis"))


def test_numbers_in_a_map_are_vertices_of_the_first_file(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A vertex where two pieces touch is split; its copy has no number in the file."""
    vertices, faces = touching()
    sx.write("touching.npz", (vertices, faces))
    first = sx.read("touching.npz", repair=True)
    assert len(first.mesh.vertices) == len(vertices) + 1
    from surfexp.tasks import distances

    found = sx.distance(BODY, BODY, 3)
    partner = np.arange(N) % 2 * len(vertices) + (np.arange(N) + 1) % 2 * -1
    object.__setattr__(found, "correspondence", partner)
    monkeypatch.setattr(distances, "distance", lambda *_, **__: found)
    assert main(["distance", "touching.npz", "good.npz", "-n", "3", "--repair", "--to", "map.npz"]) == 0
    kept = np.load("map.npz")["correspondence"]
    assert set(kept[1::2]) == {float(TIP + 1)} and set(kept[::2]) == {-1.0}
