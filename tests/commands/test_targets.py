"""What a command writes: checked before anything is computed, never over its inputs, ended with what is true."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands import processes
from surfexp.commands.command_line import main

BALL = sx.shape("icosphere", levels=2)


@pytest.fixture
def folder(working_folder: Path) -> Path:
    sx.write("ball.ply", BALL)
    noisy = BALL.mesh.vertices[:, 2] + 0.1 * np.random.default_rng(0).standard_normal(len(BALL.mesh.vertices))
    sx.write("map.csv", noisy)
    return working_folder


COMMANDS = {
    "modes": ["modes", "ball.ply", "-k", "4"],
    "denoise": ["denoise", "ball.ply", "map.csv"],
    "smooth": ["smooth", "ball.ply", "map.csv", "--width", "0.5"],
    "segment": ["segment", "ball.ply", "map.csv"],
    "skeleton": ["skeleton", "ball.ply", "map.csv"],
    "geodesic": ["geodesic", "ball.ply", "0"],
    "curvature": ["curvature", "ball.ply"],
    "plot": ["plot", "ball.ply", "map.csv"],
    "repair": ["repair", "ball.ply"],
    "distance": ["distance", "ball.ply", "ball.ply", "-n", "3"],
    "reeb-distance": ["reeb-distance", "ball.ply", "ball.ply", "--map", "map.csv"],
    "align": ["align", "ball.ply", "ball.ply", "-k", "3"],
    "nulls": ["nulls", "ball.ply", "map.csv", "--count", "3"],
    "test": ["test", "ball.ply", "map.csv", "map.csv"],
    "fingerprint": ["fingerprint", "ball.ply", "-k", "3"],
}


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("target", ["result.nosuch", "no/folder/result.csv", "."])
def test_a_target_that_cannot_be_written_is_refused_at_once(
    folder: Path, name: str, target: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_: object, **__: object) -> None:
        raise AssertionError("something was computed")

    for function in ("spectra.eigenpairs", "denoising.denoise", "denoising.smooth", "segmentation.segment"):
        monkeypatch.setattr(f"surfexp.tasks.{function}", never)
    for function in ("skeletons.reeb_graph", "skeletons.geodesic", "skeletons.mean_curvature", "pictures.plot"):
        monkeypatch.setattr(f"surfexp.tasks.{function}", never)
    for function in (
        "distances.distance",
        "mode_alignment.align",
        "fingerprints.fingerprint",
        "permutation_testing.permutation_test",
    ):
        monkeypatch.setattr(f"surfexp.tasks.{function}", never)
    assert main([*COMMANDS[name], "--to", target]) == 2
    said = capsys.readouterr().err
    assert len(said.strip().splitlines()) == 1 and "computed" not in said
    assert sorted(path.name for path in folder.iterdir()) == ["ball.ply", "map.csv"]


def test_distances_to_a_component_without_a_source_are_no_curvature_file_and_nothing_is_computed(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    faces, n = BALL.mesh.faces, len(BALL.mesh.vertices)
    sx.write("two.ply", (np.r_[BALL.mesh.vertices, BALL.mesh.vertices + 5.0], np.r_[faces, faces + n]))
    # with a source on each there is no NaN to write
    assert main(["geodesic", "two.ply", "0", str(n), "--to", "lh.far.curv"]) == 0
    monkeypatch.setattr("surfexp.tasks.skeletons.geodesic", None)
    for sources in (["0"], ["0", "1"], [str(n)]):
        assert main(["geodesic", "two.ply", *sources, "--to", "lh.near.curv"]) == 2
        assert "NaN" in capsys.readouterr().err and not Path("lh.near.curv").exists()
    assert main(["geodesic", "two.ply", "0", str(2 * n), "--to", "lh.near.curv"]) == 2
    assert f"vertex {2 * n}" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "target"),
    [
        ("skeleton", "ball.ply"),
        ("reeb-distance", "ball.npz"),
        ("repair", "ball.ply"),
        ("curvature", "ball.ply"),
        ("modes", "./ball.ply"),
        ("denoise", "map.csv"),
        ("smooth", "map.csv"),
        ("segment", "map.csv"),
        ("denoise", "link.csv"),
    ],
)
def test_no_input_is_overwritten(folder: Path, name: str, target: str, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "link.csv").symlink_to(folder / "map.csv")
    (folder / "ball.npz").hardlink_to(folder / "ball.ply")
    before = {path: Path(path).read_bytes() for path in ("ball.ply", "map.csv")}
    assert main([*COMMANDS[name], "--to", target]) == 2
    assert "would overwrite the input" in capsys.readouterr().err
    assert all(Path(path).read_bytes() == data for path, data in before.items())


def test_a_certificate_has_the_hashes_of_what_was_read(folder: Path) -> None:
    digest = {name: hashlib.sha256(Path(name).read_bytes()).hexdigest() for name in ("ball.ply", "map.csv")}
    assert main([*COMMANDS["denoise"], "--to", "clean.csv"]) == 0
    assert json.loads(Path("clean.csv.json").read_text())["inputs"] == digest


@pytest.mark.parametrize("tolerance", ["0", "-1", "nan", "2", "inf", "1e-16"])
@pytest.mark.parametrize("name", ["denoise", "segment", "modes"])
def test_a_tolerance_that_bounds_nothing_is_the_users_mistake(
    folder: Path, name: str, tolerance: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*COMMANDS[name], f"--tolerance={tolerance}", "--to", "result.vtk"]) == 2
    assert "tolerance" in capsys.readouterr().err and not Path("result.vtk").exists()


def test_an_interrupted_command_says_that_and_promises_nothing(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("surfexp.tasks.spectra.eigenpairs", interrupted)
    monkeypatch.setitem(processes._state, "driven", True)  # a run before it in the same process
    assert main([*COMMANDS["modes"], "--to", "m.npz"]) == 130
    said = capsys.readouterr().err
    assert "interrupted" in said and "kept" not in said and not Path("m.npz").exists()


def test_what_did_not_converge_ends_with_3_and_is_kept(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from dataclasses import replace

    from surfexp.tasks import denoising

    original = denoising.denoise

    def stopped(*given: object, **options: object) -> object:
        found = original(*given, **options)  # type: ignore[arg-type]
        return replace(found, certificate=found.certificate | {"converged": False})

    monkeypatch.setattr(denoising, "denoise", stopped)
    assert main([*COMMANDS["denoise"], "--to", "clean.csv"]) == 3
    assert Path("clean.csv").exists()


def test_regions_of_a_part_are_refused_where_nothing_says_outside(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("surfexp.tasks.segmentation.segment", None)
    np.save("mask.npy", BALL.mesh.vertices[:, 2] > 0)
    assert main([*COMMANDS["segment"], "--mask", "mask.npy", "--to", "lh.regions"]) == 2
    assert "lh.regions cannot say NaN" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["0123.npy", "nan.npy"])
@pytest.mark.parametrize("command", [["denoise"], ["smooth", "--width", "0.5"]])
def test_a_map_whose_name_a_table_cannot_give_back_is_refused_at_once(
    folder: Path, name: str, command: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(f"surfexp.tasks.denoising.{command[0]}", lambda *_, **__: pytest.fail("something was computed"))
    np.save(name, BALL.mesh.vertices[:, 2])
    assert main([*command, "ball.ply", name, "--to", "result.csv"]) == 2
    assert "are read as numbers in a table: rename the maps" in capsys.readouterr().err
