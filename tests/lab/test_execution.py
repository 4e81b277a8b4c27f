"""A plan carried out in one process: what is damaged or lost is named and made again, numbers come from results."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba import njit

from surfexp.commands import execution, request, results_lock, unfinished_stages
from surfexp.contract.metric import Metric
from surfexp.io.writing import write_mesh
from surfexp.lab.errors import StageFailure, UserError
from surfexp.lab.experiment.claim import read_claims
from surfexp.lab.plan.outcome import event_path
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.lab.running import stage
from surfexp.lab.store import store
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.records.table import rows_of
from surfexp.report.convergence import reason, unconverged
from surfexp.report.verdict import judge

CONFIGURATION = {
    "experiment": "toy",
    "target": "pairing",
    "surface": "toy_triangle",
    "scalar": "toy_boundary",
    "pairing": {
        "name": "toy_distance",
        "inputs": {
            "source": {"scalar": "toy_eigenfunction", "weighted": {"name": "toy_flux", "inputs": {}}},
            "target": {"scalar": {"name": "toy_boundary", "shift": 1.0}},
        },
    },
}
CONFIGURATION["pairing"]["inputs"]["source"]["weighted"]["inputs"] = {"weight": {"scalar": "toy_boundary"}}

Run = Callable[[], list[str]]


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    registry.load_file(Path(__file__).with_name("toy_plugins.py"))
    return make_plan([{**CONFIGURATION, "results": str(tmp_path / "results")}])


@pytest.fixture
def run(plan: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run the plan with its stages in this process; return the names of those that were started."""
    started: list[str] = []

    def in_this_process(plan: Plan, path: Path, results: Path, missing: Any) -> None:
        wanted = {node.key for node in missing}
        started.extend(node.plugin for node in plan.stored if node.key in wanted)
        for key in plan.nodes:
            if key in wanted:
                stage.run_stage(path, key)

    def once() -> list[str]:
        started.clear()
        execution.run(plan)
        return list(started)

    monkeypatch.setenv(results_lock.HELD, "1")
    monkeypatch.setattr(execution, "_snakemake", in_this_process)
    monkeypatch.setattr(execution, "finish", lambda *given: None)
    return once


def store_bytes(results: Path) -> dict[str, bytes]:
    return {str(file.relative_to(results)): file.read_bytes() for file in (results / "store").rglob("*.*")}


def node_of(plan: Plan, plugin: str) -> Any:
    return next(node for node in plan.stored if node.plugin == plugin)


def flip(file: Path) -> None:
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)


@pytest.mark.parametrize("name", ["record.json", "arrays.npz"])
@pytest.mark.parametrize("change", ["flip", "empty", "remove"])
def test_damage_is_named_and_only_the_damaged_result_is_made_again(
    run: Run, plan: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, change: str
) -> None:
    results = tmp_path / "results"
    assert len(run()) == 6 and run() == []
    undisturbed = store_bytes(results)
    for plugin in ("toy_flux", "toy_distance"):  # in the middle and at the end
        node = node_of(plan, plugin)
        file = store.result_folder(results, node.kind, node.key) / name
        {"flip": flip, "empty": lambda file: file.write_bytes(b""), "remove": Path.unlink}[change](file)
        capsys.readouterr()
        assert run() == [plugin]
        said = capsys.readouterr().err
        assert (name, change) == ("record.json", "remove") or (f"{node.kind}/{node.key}" in said and name in said)
        assert len(said.splitlines()) <= 1 and store_bytes(results) == undisturbed


def test_damage_that_only_the_reader_notices_is_made_again_in_the_same_run(
    run: Run, plan: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    results = tmp_path / "results"
    run()
    undisturbed = store_bytes(results)
    flux, reader = node_of(plan, "toy_flux"), node_of(plan, "toy_eigenfunction")
    flip(store.result_folder(results, flux.kind, flux.key) / "arrays.npz")
    store.discard(results, reader.kind, reader.key)
    # as if nothing about the file had changed since it was hashed: bits that went bad on the disk
    faults, first = store.faults, [True]

    def blind(results: Path, stages: Any, anew: bool = False) -> dict[str, str]:
        found = faults(results, stages, anew)
        return {reader.key: ""} if first and first.pop() else found

    monkeypatch.setattr(store, "faults", blind)
    assert run() == ["toy_eigenfunction", "toy_flux", "toy_eigenfunction"]
    assert f"{flux.kind}/{flux.key} is damaged: arrays.npz" in capsys.readouterr().err.splitlines()[-1]
    assert store_bytes(results) == undisturbed


def test_a_lost_event_takes_the_clock_and_no_number(run: Run, plan: Plan, tmp_path: Path) -> None:
    results, leaf = tmp_path / "results", plan.nodes[plan.leaves[0].key]
    run()
    (before,) = rows_of(plan, results)
    assert before.metrics == {"distance": 1.0} and before.seconds is not None and not before.failure
    for content in (None, "", "[1", '{"seconds": "fast"}', "\x00"):
        file = event_path(results, leaf.kind, leaf.key)
        file.unlink(missing_ok=True) if content is None else file.write_text(content)
        (row,) = rows_of(plan, results)
        assert row.metrics == before.metrics and row.seconds is None and not row.failure
        assert run() == []


def test_what_is_written_into_an_event_changes_no_number_and_no_verdict(run: Run, plan: Plan, tmp_path: Path) -> None:
    results, leaf = tmp_path / "results", plan.nodes[plan.leaves[0].key]
    run()
    claims = [
        {"claim": "small", "quantity": {"all": "distance"}, "between": [None, 0.5], "because": "half a side"},
        {
            "claim": "adjoint",
            "quantity": {"all": "adjointness_defect"},
            "between": [None, 1e-12],
            "because": "0",
        },
    ]
    verdicts = [item.verdict for item in judge(read_claims(claims), rows_of(plan, results))]
    file = event_path(results, leaf.kind, leaf.key)
    invented = {"metrics": {"distance": 0.1, "adjointness_defect": 1e-20}, "notes": ["fine"], "failure": "never ran"}
    file.write_text(json.dumps(json.loads(file.read_text()) | invented))
    (row,) = rows_of(plan, results)
    assert row.metrics == {"distance": 1.0} and row.notes == [] and not row.failure
    assert [item.verdict for item in judge(read_claims(claims), [row])] == verdicts and verdicts[1] == "not computed"


def test_a_store_without_digests_is_made_again_with_a_line_for_each(
    run: Run, plan: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = tmp_path / "results"
    run()
    undisturbed = store_bytes(results)
    for file in results.glob("store/*/*/record.json"):
        file.write_text(json.dumps(json.loads(file.read_text())["result"], indent=1, sort_keys=True) + "\n")
    assert len(run()) == 6 and capsys.readouterr().err.count("of an earlier version, which stored no digests") == 6
    assert store_bytes(results) == undisturbed


def test_where_clocks_matter_a_leaf_is_measured_alone_and_once(run: Run, plan: Plan) -> None:
    run()
    plan.settings = plan.settings.model_copy(update={"timing": True})
    assert run() == ["toy_distance"]  # its seconds may be those of a busy machine
    assert run() == []
    results = Path(plan.settings.results)
    event_path(results, "pairing", plan.leaves[0].key).unlink()
    undisturbed = store_bytes(results)
    execution.before_snakemake(plan, results)  # plain Snakemake may be in a dry run: what is sound stays
    assert store_bytes(results) == undisturbed
    assert run() == ["toy_distance"]
    plan.settings = plan.settings.model_copy(update={"timing": False})
    assert run() == []


def test_a_result_that_is_measured_again_is_kept_until_the_new_one_is_there(
    run: Run, plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    run()
    results = Path(plan.settings.results)
    sound = store_bytes(results)
    timed = plan.settings.model_copy(update={"timing": True})
    plain, plan.settings = plan.settings, timed
    with monkeypatch.context() as interrupted:
        interrupted.setattr(execution, "_snakemake", interrupt)
        with pytest.raises(KeyboardInterrupt):
            run()
    assert store_bytes(results) == sound
    module = sys.modules[registry.plugin("pairing", "toy_distance").function.__module__]
    with monkeypatch.context() as failing, pytest.raises(StageFailure, match="division by zero"):
        failing.setattr(module, "Pairing", lambda *values, **metrics: 1 / 0)
        run()
    assert store_bytes(results) == sound
    unfinished_stages.clear(
        plan, results, unfinished_stages.unfinished(plan, results)
    )  # killed with nothing but that done
    assert store_bytes(results) != sound
    plan.settings = plain
    assert run() == [] and store_bytes(results) == sound
    plan.settings = timed
    assert run() == ["toy_distance"] and run() == [] and store_bytes(results) == sound


def interrupt(*given: Any) -> None:
    raise KeyboardInterrupt


def test_a_failure_is_told_once_and_not_tried_twice(run: Run, plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    module = sys.modules[registry.plugin("pairing", "toy_distance").function.__module__]
    monkeypatch.setattr(module, "Pairing", lambda *values, **metrics: 1 / 0)
    with pytest.raises(StageFailure, match="pairing/toy_distance: division by zero"):
        run()


def test_a_failure_names_the_files_that_it_failed_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two bodies have fewer vertices than eigenpairs are asked for; the third is large enough."""
    surfaces = []
    for name, levels in (("tiny", 0), ("small", 0), ("large", 2)):
        mesh = icosphere(levels).mesh
        write_mesh(
            tmp_path / f"{name}.ply", TriangleMesh((2.0 if name == "small" else 1.0) * mesh.vertices, mesh.faces)
        )
        surfaces.append({"name": "file", "path": str(tmp_path / f"{name}.ply")})
    load_all(tmp_path)
    shared = {"experiment": "own", "target": "signature", "operator": "fem", "results": str(tmp_path / "results")}
    plan = make_plan([{**shared, "surface": one, "signature": {"name": "spectral", "count": 20}} for one in surfaces])

    def in_this_process(plan: Plan, path: Path, results: Path, missing: Any) -> None:
        for key in plan.nodes:
            if key in {node.key for node in missing}:
                stage.run_stage(path, key)

    monkeypatch.setenv(results_lock.HELD, "1")
    monkeypatch.setattr(execution, "_snakemake", in_this_process)
    monkeypatch.setattr(execution, "finish", lambda *_: None)
    with pytest.raises(
        StageFailure, match=r"12 degrees of freedom: take 1 <= k <= 12 \((tiny|small).ply, (tiny|small).ply\)$"
    ):
        execution.run(plan)


def loose(tmp_path: Path, target: str = "solver", **options: Any) -> Plan:
    """Two rows: one within its bound, the other as the options say."""
    registry.load_file(Path(__file__).with_name("toy_plugins.py"))
    shared = {
        "experiment": "loose",
        "title": "Loose ends",
        "results": str(tmp_path / "results"),
        "surface": "toy_triangle",
    }
    solvers = [{"name": "toy_loose", "gap": 1e-5}, {"name": "toy_loose", **options}]
    stages = {"target": target, "pairing": "toy_judge"}
    return make_plan([{**shared, **stages, "solver": solver} for solver in solvers])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"gap": 1.45}, "its relative gap is 1.45, over 1"),
        ({"gap": None}, "its relative gap is nan, over 1"),
        ({"gap": 1e-5, "converged": False}, "did not converge"),
    ],
)
@pytest.mark.parametrize("target", ["solver", "pairing"])
def test_a_row_that_did_not_converge_is_named_and_ends_with_3(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    run: Run,
    options: dict[str, Any],
    said: str,
    target: str,
) -> None:
    plan = loose(tmp_path, target, **options)
    monkeypatch.setattr("surfexp.lab.composition.launch.launch", lambda arguments, action: action(plan))
    monkeypatch.setattr(request, "place", lambda arguments: None)  # the request is none of this plan
    assert request.carried_out("run", []) == 3
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("surfexp: warning: ") and line.endswith(said)
    assert ("Loose ends: " if target == "solver" else "solver/toy_loose") in line


def test_a_run_within_its_bounds_ends_with_0(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run: Run) -> None:
    # the second row says that it converged: by a bound of its own, such as the change of a published iteration
    plan = loose(tmp_path, gap=1e-3, tolerance=1e-4)
    monkeypatch.setattr("surfexp.lab.composition.launch.launch", lambda arguments, action: action(plan))
    monkeypatch.setattr(request, "place", lambda arguments: None)  # the request is none of this plan
    assert request.carried_out("run", []) == 0
    assert unconverged(plan, tmp_path / "results") == []


def test_a_metric_is_held_against_the_option_that_bounds_it_where_no_result_says_whether_it_converged() -> None:
    meanings = {"relative_gap": Metric("gap", bound="tolerance")}
    assert (
        reason({"relative_gap": 1e-3}, {"tolerance": 1e-4}, meanings)
        == "its relative gap is 0.001, over its tolerance 0.0001"
    )
    assert reason({"relative_gap": 1e-3, "converged": 1.0}, {"tolerance": 1e-4}, meanings) == ""
    assert reason({"relative_gap": 1e-3}, {"tolerance": 1e-3}, meanings) == ""


def test_many_warnings_are_cut(capsys: pytest.CaptureFixture[str]) -> None:
    request.warn([f"row {k}" for k in range(15)])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 11 and lines[-1] == "surfexp: warning: and 5 more"


@pytest.mark.parametrize("name", ["what?", "a{b}", "}", "a\nb", "a\tb", "\u202egnp"])
def test_a_results_folder_whose_name_nobody_can_carry_is_refused_before_anything_is_written(
    plan: Plan, tmp_path: Path, name: str
) -> None:
    plan.settings.results = str(tmp_path / name)
    before = sorted(tmp_path.iterdir())
    with pytest.raises(UserError, match="choose another name"):
        execution.run(plan)
    assert sorted(tmp_path.iterdir()) == before


def test_a_stage_that_does_not_compile_says_so_in_a_sentence(
    plan: Plan, run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    @njit
    def least(numbers: Any) -> Any:
        return min(0.0, numbers)

    monkeypatch.setattr(stage, "make", lambda *_: least(np.zeros(3)))
    with pytest.raises(StageFailure):
        run()
    event = json.loads(event_path(tmp_path / "results", plan.stored[0].kind, plan.stored[0].key).read_text())
    assert "does not compile for these inputs" in event["failure"] and "TypingError" in event["failure"]
    assert len(event["failure"]) < 250 and "nopython" not in event["failure"]
