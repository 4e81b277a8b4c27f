"""`surfexp export --bundle` and `surfexp rerun`: the same comes out, and hostile bundles are refused by name."""

from __future__ import annotations

import hashlib
import io
import json
import shutil
import stat
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from email.message import Message
from pathlib import Path
from typing import Any
from urllib.response import addinfourl

import numpy as np
import pytest

import surfexp as sx
from surfexp.commands.bundling.agreement import agreement, content_digest, proved
from surfexp.commands.bundling.opening import METADATA, fault_of, opened, unpack
from surfexp.commands.bundling.rerun_bundle import check_paths
from surfexp.commands.command_line import main
from surfexp.commands.exporting.writers import arrays_of
from surfexp.io import unpacked_sizes
from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import Node, Plan
from surfexp.skeleton.feature import Feature
from surfexp.variational.solution import Solution

FILES = {"plan.json": b"{}", "bundle.json": b"{}", "published/metrics.csv": b"a\n1\n"}
PLUGIN = '''"""A power of the height."""
from typing import Annotated
from pydantic import Field
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature


@register("feature", "height_power", metrics={"largest": Metric("largest value")})
def height_power(
    surface: Surface, *, power: Annotated[float, Field(gt=0, description="of the height")] = 2.0
) -> Feature:
    """Raise the height of vertices to a power."""
    values = abs(surface.mesh.vertices[:, 2]) ** power
    return Feature(values, name="height power", metrics={"largest": float(values.max())})
'''
EXPERIMENT = """
target: feature
surface: {name: file, path: "my mesh.off"}
feature: height_power
grid: {feature.power: [1.0, 2.0]}
claims:
  - {claim: "Heights of a sphere: at most its radius", quantity: {all: largest}, between: [0.9, 1.1]}
"""


def archive(path: Path, files: Mapping[str, bytes], listed: Mapping[str, bytes] | None = None) -> Path:
    """A bundle of some files, whose list has the digests of others."""
    graph = [
        {"@id": name, "sha256": hashlib.sha256(content).hexdigest()} for name, content in (listed or files).items()
    ]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as written:
        written.writestr(METADATA, json.dumps({"@graph": graph}))
        for name, content in files.items():
            written.writestr(name, content)
    return path


def test_a_sound_bundle_is_unpacked_byte_for_byte(tmp_path: Path) -> None:
    bundle = archive(tmp_path / "a.zip", FILES)
    unpack(bundle, opened(bundle), tmp_path / "new")
    assert {name: (tmp_path / "new" / name).read_bytes() for name in FILES} == FILES


HOSTILE = (
    "../evil.py", "/etc/passwd", "inputs/../../evil", "inputs//a", "inputs/./a", "inputs/a\\..\\b", "C:/evil", "inputs/a\nb",
    ".bashrc", "sitecustomize.py", "conf/config.yaml", "profiles/default/config.yaml", "results/store/a", f"inputs/{'a' * 300}",
)  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_names_are_refused_by_name(tmp_path: Path, name: str) -> None:
    bundle = archive(tmp_path / "a.zip", FILES | {name: b"x"})
    with pytest.raises(UserError, match="nothing was unpacked") as refused:
        opened(bundle)
    assert repr(name) in str(refused.value) and "\n" not in str(refused.value)


def test_links_and_names_that_differ_in_case_alone_are_refused(tmp_path: Path) -> None:
    assert "link" in fault_of("inputs/a", stat.S_IFLNK | 0o777)
    assert not fault_of("inputs/a", stat.S_IFREG | 0o644)
    with pytest.raises(UserError, match="twice"):
        opened(archive(tmp_path / "a.zip", FILES | {"inputs/a": b"1", "inputs/A": b"2"}))


@pytest.mark.parametrize("name", FILES)
def test_changed_bytes_are_refused_by_name(tmp_path: Path, name: str) -> None:
    bundle = archive(tmp_path / "a.zip", FILES | {name: FILES[name] + b" "}, FILES)
    with pytest.raises(UserError, match="was changed") as refused:
        opened(bundle)
    assert repr(name) in str(refused.value)


def test_files_beyond_the_list_and_lost_ones_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"'plugins/feature/a.py' is in the archive and not in"):
        opened(archive(tmp_path / "a.zip", FILES | {"plugins/feature/a.py": b"1"}, FILES))
    with pytest.raises(UserError, match=r"'bundle.json' is not in the archive, but in"):
        opened(archive(tmp_path / "b.zip", {"plan.json": b"{}"}, {"plan.json": b"{}", "bundle.json": b"{}"}))


def test_what_unpacks_to_too_much_is_refused_before_it_is_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unpacked_sizes, "ALWAYS_READ", 1 << 16)
    bundle = archive(tmp_path / "a.zip", FILES | {"inputs/zeros": bytes(1 << 20)})
    with pytest.raises(UserError, match="unpacked it has over"):
        opened(bundle)


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04" + bytes(100)])
def test_what_is_no_archive_is_refused_in_one_line(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.zip").write_bytes(content)
    with pytest.raises(UserError, match="is no bundle") as refused:
        opened(tmp_path / "a.zip")
    assert "\n" not in str(refused.value)


def test_an_archive_without_a_list_or_a_plan_is_no_bundle(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as written:
        written.writestr("plan.json", "{}")
    with pytest.raises(UserError, match="no bundle of surfexp"):
        opened(tmp_path / "a.zip")
    with pytest.raises(UserError, match=r"has no plan\.json"):
        opened(archive(tmp_path / "b.zip", {"bundle.json": b"{}"}))
    with pytest.raises(UserError, match=r"has no bundle\.json"):
        opened(archive(tmp_path / "c.zip", {"plan.json": b"{}"}))


def test_a_bundle_of_another_version_is_told_in_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["rerun", str(archive(tmp_path / "a.zip", FILES))]) == 2
    said = capsys.readouterr().err
    assert "bundle.json of the bundle cannot be read" in said and said.count("\n") == 1


def test_nothing_is_unpacked_over_files_that_are_there(tmp_path: Path) -> None:
    bundle, folder = archive(tmp_path / "a.zip", FILES), tmp_path / "mine"
    folder.mkdir()
    (folder / "plan.json").write_text("mine")
    with pytest.raises(UserError, match="is not empty"):
        unpack(bundle, opened(bundle), folder)
    assert (folder / "plan.json").read_text() == "mine"


@pytest.mark.parametrize(
    ("path", "inside"),
    [("inputs/ab/ball.off", True), ("/etc/hostname", False), ("inputs/../../ball.off", False), ("inputs/link", False)],
)
def test_a_plan_names_no_file_outside_of_its_bundle(path: str, inside: bool, tmp_path: Path) -> None:
    (tmp_path / "inputs").mkdir()
    (tmp_path / "inputs" / "link").symlink_to("/etc/hostname")
    node = Node(
        "k", "surface", "file", "", "", "", {"path": path, "maps": {"a": path}}, {}, {"path": "0", "maps.a": "0"}
    )
    plan = Plan(None, {"k": node})  # type: ignore[arg-type]
    if inside:
        check_paths(plan, tmp_path)
    else:
        with pytest.raises(UserError, match=r"surface/file: path is .* outside of the bundle"):
            check_paths(plan, tmp_path)


def solution(low: float, high: float, **more: Any) -> Solution:
    return Solution(np.zeros(3), high, lower_bound=low, **more)


@pytest.mark.parametrize(
    ("before", "again", "state"),
    [
        ((1.0, 2.0), (1.5, 3.0), "within certificates"),
        ((1.0, 2.0), (2.0, 3.0), "within certificates"),
        ((1.0, 2.0), (2.0 + 1e-6, 3.0), "differs"),
        ((2.0 + 1e-6, 3.0), (1.0, 2.0), "differs"),
    ],
)
def test_energies_agree_where_one_least_energy_fits_both(before: Any, again: Any, state: str) -> None:
    assert agreement(solution(*before), solution(*again)).state == state


def test_a_row_that_converges_no_more_differs() -> None:
    found = agreement(solution(1.0, 2.0), solution(1.0, 2.0, converged=False))
    assert (found.state, found.reason) == ("differs", "converged is False, before True")


def test_each_eigenvalue_is_held_against_its_own_residual() -> None:
    system = sx.eigenpairs(sx.shape("icosphere", levels=2), 6)
    assert len(proved(system)) == 6
    loose = replace(system, residuals=np.full(6, 1e-3))
    radii, last = 1e-3 * np.maximum(np.abs(loose.values), loose.spacing), np.arange(6) == 5
    assert agreement(loose, replace(loose, values=loose.values + 1.9 * radii * last)).state == "within certificates"
    found = agreement(loose, replace(loose, values=loose.values - 2.1 * radii * last))
    assert found.state == "differs" and found.reason.startswith("eigenvalue 5 in")
    near_zero = np.arange(6) == 0
    assert agreement(loose, replace(loose, values=loose.values + 1.9 * radii * near_zero)).holds
    assert not agreement(loose, replace(loose, values=loose.values + 2.1 * radii * near_zero)).holds
    assert agreement(system, replace(system, complete=False)).state == "differs"


def test_what_proves_nothing_agrees_to_rounding_alone() -> None:
    values = np.array([1.0, -2.0, 3.0])
    feature = Feature(values, name="a", metrics={"largest": 3.0})
    assert agreement(feature, replace(feature, values=values * (1 + 1e-11))).state == "within rounding"
    found = agreement(feature, replace(feature, values=values * (1 + 1e-7)))
    assert found.state == "differs" and found.reason.startswith("values by 1.0e-07")
    assert agreement(feature, replace(feature, metrics={"largest": 4.0})).state == "differs"
    assert agreement(feature, replace(feature, values=values[:2])).state == "differs"
    assert agreement(feature, solution(1.0, 2.0)).state == "differs"
    assert set(arrays_of(feature)) == {"values"}


def test_a_digest_is_of_what_was_computed_not_of_the_key() -> None:
    record = {"kind": "feature", "key": "a", "arrays": "b", "result": {"class": "feature", "fields": {"name": "c"}}}
    assert content_digest(record) == content_digest(record | {"key": "d"})
    assert content_digest(record) != content_digest(record | {"arrays": "d"})
    assert content_digest(record) != content_digest(record | {"result": {}})


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bundle of an experiment with a plugin and a mesh of its own."""
    pytest.importorskip("rocrate")
    folder = tmp_path_factory.mktemp("own")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for name, text in (("plugins/feature/height_power.py", PLUGIN), ("conf/experiment/mine.yaml", EXPERIMENT)):
            Path(name).parent.mkdir(parents=True)
            Path(name).write_text(text)
        sx.write("my mesh.off", sx.shape("icosphere", levels=2))
        assert main(["run", "experiment=mine"]) == 0
        assert main(["export", "mine", "--bundle"]) == 0
    return folder / "mine.crate.zip"


@pytest.fixture
def elsewhere(bundle: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the bundle where nothing else is."""
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copy(bundle, tmp_path))


def rerun(*arguments: str) -> tuple[int, str, str]:
    """In a process of its own, which has not loaded the plugin from elsewhere; exit code, output, errors."""
    command = [
        sys.executable,
        "-c",
        "from surfexp.commands.command_line import main; raise SystemExit(main())",
        "rerun",
    ]
    done = subprocess.run([*command, *arguments], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.optional
@pytest.mark.slow
def test_a_bundle_runs_again_elsewhere_with_the_same_digests(elsewhere: Path, tmp_path: Path) -> None:
    code, _, said = rerun(elsewhere.name)
    assert code == 2 and "plugins/feature/height_power.py" in said and said.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == [elsewhere.name]  # nothing ran, nothing was written
    code, shown, _ = rerun(elsewhere.name, "--trust")
    assert code == 0 and "2 rows: 2 same; 1 of 1 verdicts the same" in shown
    found = json.loads((tmp_path / "mine-rerun" / "rerun.json").read_text())
    assert [row["key"] == row["key here"] for row in found["rows"]] == [True, True]


@pytest.mark.optional
@pytest.mark.slow
def test_another_plugin_in_a_bundle_is_told_as_a_difference(elsewhere: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(elsewhere) as read:
        files = {name: read.read(name) for name in read.namelist() if name != METADATA}
    files["plugins/feature/height_power.py"] = PLUGIN.replace("** power", "** power * 2").encode()
    archive(tmp_path / "other.zip", files)
    code, shown, _ = rerun("other.zip", "--trust")
    assert code == 1 and "2 rows: 2 differs; 0 of 1 verdicts the same" in shown
    assert "by 1.0e+00 of its largest" in shown and "does not hold, before holds: Heights of a sphere: at most" in shown


@pytest.mark.optional
@pytest.mark.slow
def test_a_bundle_holds_tables_certificates_and_citations(elsewhere: Path) -> None:
    pandas = pytest.importorskip("pandas")
    names = opened(elsewhere)
    assert {"Snakefile", "config.yaml", "conf/experiment/mine.yaml", "published/citations.bib"} <= set(names)
    with zipfile.ZipFile(elsewhere) as read:
        content = {name: read.read(name) for name in names}
    files = [
        name for name in names if name.startswith("published/files/") and not name.endswith((".json", "index.csv"))
    ]
    assert files and all(json.loads(content[f"{name}.json"])["key"] for name in files)
    table = pandas.read_parquet(io.BytesIO(content["published/metrics.parquet"]))
    text = pandas.read_csv(io.BytesIO(content["published/metrics.csv"]))
    assert list(table.columns) == list(text.columns) and (table["largest"] == text["largest"]).all()
    assert content["plugins/feature/height_power.py"] == PLUGIN.encode()
    assert b"/my mesh.off" in content["plan.json"] and str(elsewhere.parent).encode() not in content["plan.json"]


@pytest.mark.optional
@pytest.mark.slow
def test_a_bundle_is_a_valid_workflow_run_crate(elsewhere: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the validator, with the terms of the specification from the library instead of the net."""
    services = pytest.importorskip("rocrate_validator.services")
    import requests
    import rocrate
    from rdflib import parser
    from rocrate_validator.models import Severity

    terms = json.loads((Path(rocrate.__file__).parent / "data" / "ro-crate.jsonld").read_text())
    terms["@context"]["ComputationalWorkflow"] = "https://bioschemas.org/ComputationalWorkflow"  # as in version 1.1
    served, head = json.dumps(terms).encode(), Message()
    head["Content-Type"] = "application/ld+json"

    def answer(session: Any, request: Any, **options: Any) -> requests.Response:
        response = requests.Response()
        response.status_code, response.url, response.request = 200, request.url, request
        response._content = served
        response.headers["Content-Type"] = "application/ld+json"
        return response

    monkeypatch.setattr(parser, "_urlopen", lambda request: addinfourl(io.BytesIO(served), head, request.full_url, 200))
    monkeypatch.setattr(requests.Session, "send", answer)
    asked = services.ValidationSettings(
        rocrate_uri=str(elsewhere),
        profile_identifier="workflow-run-crate",
        requirement_severity=Severity.REQUIRED,
        no_cache=True,
    )
    result = services.validate(asked)
    assert result.passed(), [issue.message for issue in result.get_issues()]


@pytest.mark.optional
@pytest.mark.slow
def test_results_that_are_gone_are_told_before_a_bundle_is_written(
    bundle: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(bundle.parent, tmp_path / "own", ignore=shutil.ignore_patterns("*.zip"))
    monkeypatch.chdir(tmp_path / "own")
    Path("my mesh.off").write_text("other")
    assert main(["export", "mine", "--bundle"]) == 2
    assert "my mesh.off is not what it was" in capfd.readouterr().err
    shutil.rmtree("results/store/feature")
    assert main(["export", "mine", "--bundle"]) == 2
    assert "2 of 2 results are missing" in capfd.readouterr().err
    assert not Path("mine.crate.zip").exists()
