"""Collections of a user's own: collect reads and lists, fetch pins, and a run takes the axis."""

from __future__ import annotations

import subprocess
import sys
import threading
import zipfile
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import numpy as np
import pytest
import yaml
from pydantic import ValidationError

from surfexp.commands.command_line import main
from surfexp.io.writing import write_mesh
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.triangle_mesh import TriangleMesh

load_all(Path("/nonexistent"))


def write_tables(stem: Path, mesh: TriangleMesh) -> None:
    np.savetxt(stem.with_suffix(".vert"), mesh.vertices, fmt="%.17g")
    np.savetxt(stem.with_suffix(".tri"), mesh.faces + 1, fmt="%d")


@pytest.fixture
def shapes(working_folder: Path) -> Path:
    folder = working_folder / "shapes"
    folder.mkdir()
    for number in (0, 1, 10):
        write_tables(folder / f"ball{number}", icosphere(1 + number % 2).mesh)
    for number in (0, 2):
        write_mesh(folder / f"ring{number}.off", torus(8 + number, 6).mesh)
    (folder / "ring7.off").write_text("OFF\n3 1 0\n0 0 0\n1 0\n")
    (folder / "notes.txt").write_text("no mesh")
    return folder


def key_of(**surface: object) -> str:
    return make_plan(expand({"target": "surface", "surface": surface})).leaves[0].key


def test_the_key_covers_both_tables_and_no_other_file(shapes: Path) -> None:
    for name in ("tosca", "file"):
        before = key_of(name=name, path=str(shapes / "ball0.vert"))
        (shapes / "notes.txt").write_text(f"changed beside it, {name}")
        from surfexp.lab.digests import file_digest

        file_digest.cache_clear()
        assert key_of(name=name, path=str(shapes / "ball0.vert")) == before
        with (shapes / "ball0.tri").open("a") as table:
            table.write("1 2 3\n")
        file_digest.cache_clear()
        assert key_of(name=name, path=str(shapes / "ball0.vert")) != before
    assert key_of(name="tosca", path=str(shapes), shape="ball1") == key_of(
        name="tosca", path=str(shapes / "ball1.vert"), shape="ball1"
    )


@pytest.mark.parametrize(
    ("path", "shape", "message"),
    [
        ("shapes", "bal1", "no shape 'bal1'; choose for example ball1"),
        ("shapes/ball0.vert", "ring0", "is not the shape"),
    ],
)
def test_a_shape_that_is_not_there(shapes: Path, path: str, shape: str, message: str) -> None:
    options = registry.plugin("surface", "tosca").options
    with pytest.raises(ValidationError, match=message):
        options(path=shapes.parent / path, shape=shape)


def test_collect_writes_a_dataset_and_lists_what_is_left_out(shapes: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["collect", str(shapes), "--to", "mine"]) == 0
    said = capsys.readouterr().out
    assert "5 of 6 files are items: ball 3, ring 2" in said and "left out: ring7.off" in said
    written = (shapes.parent / "conf" / "datasets" / "mine.yaml").read_text()
    items = yaml.safe_load(written)["shapes"]
    assert [item["label"] for item in items] == ["ball ball0", "ball ball1", "ball ball10", "ring ring0", "ring ring2"]
    surface = {"name": "file", "path": str(shapes / "ring2.off")}
    assert items[-1] == {"label": "ring ring2", "class": "ring", "group": "ring2", "surface": surface}
    assert "# left out: ring7.off" in written
    assert main(["collect", str(shapes), "--to", "mine"]) == 2 and "--force" in capsys.readouterr().err


FORMATS = (".off", ".obj", ".ply", ".stl", ".vtk", ".vtp", ".surf.gii")


def test_a_folder_is_read_alike_by_collect_and_fingerprint(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (working_folder / "shapes").mkdir()
    for number, suffix in enumerate(FORMATS):
        write_mesh(working_folder / "shapes" / f"torus{number}{suffix}", torus(8 + number, 6).mesh)
    assert main(["collect", "shapes", "--to", "mine"]) == 0
    assert f"{len(FORMATS)} of {len(FORMATS)} files are items: torus {len(FORMATS)}" in capsys.readouterr().out
    assert main(["fingerprint", "shapes", "-k", "2", "--to", "table.csv"]) == 0
    assert len((working_folder / "table.csv").read_text().splitlines()) == 1 + len(FORMATS)


def test_a_dataset_is_named_with_or_without_its_suffix_and_is_whole_or_not_there(
    shapes: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["collect", str(shapes), "--to", "mine.yaml"]) == 0
    before = Path("conf/datasets/mine.yaml").read_bytes()
    monkeypatch.setattr(Path, "write_text", lambda *_, **__: (_ for _ in ()).throw(OSError(28, "No space left")))
    assert main(["collect", str(shapes), "--to", "mine.yaml", "--force"]) == 1
    assert [file.name for file in Path("conf/datasets").iterdir()] == ["mine.yaml"]
    assert Path("conf/datasets/mine.yaml").read_bytes() == before


@pytest.mark.slow
def test_a_run_takes_the_collection_in_place_of_its_own(shapes: Path) -> None:
    assert main(["collect", str(shapes), "--to", "mine"]) == 0
    command = [sys.executable, "-m", "surfexp.commands.command_line", "plan", "experiment=tosca_classification"]
    # five members, of which ball0 and ball10 hold the same bytes
    for datasets, count in ((["datasets=mine"], 4), ([], 36)):
        said = subprocess.run([*command, *datasets], capture_output=True, text=True).stdout
        row = next(line for line in said.splitlines() if "surface" in line)
        assert row.split("│")[2].strip() == str(count), said
    unknown = subprocess.run([*command, "datasets=min"], capture_output=True, text=True)
    assert unknown.returncode == 2 and "'min'; did you mean 'mine'?" in unknown.stderr


def test_people_by_a_regular_expression(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for person in ("anna", "ben"):
        for side in ("lh", "rh"):
            folder = working_folder / "people" / person
            folder.mkdir(parents=True, exist_ok=True)
            write_mesh(folder / f"{side}.ply", icosphere(1).mesh)
    group = r"(?P<owner>[^/]+)/(?P<class>.h)"
    assert main(["collect", "people", "--group", group, "--dataset", "subjects"]) == 0
    items = yaml.safe_load((working_folder / "conf" / "datasets" / "people.yaml").read_text())["subjects"]
    assert [item["label"] for item in items] == ["lh anna", "rh anna", "lh ben", "rh ben"]
    assert [(item["class"], item["group"]) for item in items][1:3] == [("rh", "anna"), ("lh", "ben")]
    wrong = (
        (r"(?P<class>x)", "finds no class"),
        ("(", "no regular expression"),
        (r"(?P<class>.h)", "two files are called"),
    )
    for pattern, message in wrong:
        assert main(["collect", "people", "--group", pattern, "--force"]) == 2
        assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere"], "does not exist"),
        (["shapes", "--pattern", "*.stl"], "set --pattern"),
        (["shapes", "--pattern", "ring7.off"], "0 surfaces can be read"),
        (["shapes", "--surface", "torus"], "reads no path"),
        (["shapes", "--surface", "fil"], "did you mean 'file'"),
    ],
)
def test_collect_refuses_in_one_line(
    shapes: Path, arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["collect", *arguments]) == 2
    error = capsys.readouterr().err
    assert message in error and len(error.splitlines()) == 1


@pytest.mark.optional
def test_fetch_pins_the_first_download(working_folder: Path, shapes: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pooch")
    site = working_folder / "site"
    site.mkdir()
    archive = site / "tosca.zip"
    with zipfile.ZipFile(archive, "w") as bundle:
        for file in sorted(shapes.glob("ball*")):
            bundle.write(file, file.name)
    quiet = type("Quiet", (SimpleHTTPRequestHandler,), {"log_message": lambda *_: None})
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(quiet, directory=str(site))) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        url = f"http://127.0.0.1:{server.server_port}/tosca.zip"
        assert main(["fetch", "tosca", "--to", "got", "--url", url]) == 0
        assert "trusted at this first download" in capsys.readouterr().out
        assert (Path("got") / "shapes" / "ball0.tri").is_file()
        assert main(["fetch", "tosca", "--to", "got", "--url", url]) == 0
        assert "trusted" not in capsys.readouterr().out
        archive.write_bytes(b"another file")
        Path("got/tosca.zip").unlink()
        assert main(["fetch", "tosca", "--to", "got", "--url", url]) == 2
        assert "pinned" in capsys.readouterr().err
        assert main(["fetch", "tosca", "--to", "other", "--url", url + ".missing"]) == 2
        assert "--url" in capsys.readouterr().err
        server.shutdown()


def test_fetch_without_pooch_says_so(
    working_folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "pooch", None)
    assert main(["fetch", "tosca"]) == 2
    assert "pip install 'surfexp[peers]'" in capsys.readouterr().err
