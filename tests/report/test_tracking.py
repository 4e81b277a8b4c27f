"""Runs in MLflow: what its client would write, in a number of statements that does not grow with the number of runs."""

from __future__ import annotations

import copy
import hashlib
import json
import math
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import sqlalchemy
from click.testing import CliRunner

from audits.benchmarks.synthetic_results import fill, plan_of, sweep
from surfexp.commands import ui
from surfexp.lab.plan.outcome import event_path
from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import store
from surfexp.records import run_client, run_content, run_database, tracking
from surfexp.records.leaf_run import names_of_runs
from surfexp.records.run_names import run_names, run_place
from surfexp.report.page import write_report

OWN = {"current": "true", "failure": ""}


@pytest.fixture(scope="module")
def empty_database(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database without runs: MLflow takes seconds to make its tables."""
    from mlflow.store.tracking.sqlalchemy_store import SqlAlchemyStore

    file = tmp_path_factory.mktemp("database") / "mlflow.db"
    SqlAlchemyStore(f"sqlite:///{file}", str(file.parent))
    return file


@pytest.fixture
def results(tmp_path: Path, empty_database: Path) -> Path:
    shutil.copy(empty_database, tmp_path / "mlflow.db")
    return tmp_path


def finished(leaves: int, results: Path) -> Plan:
    plan = plan_of(sweep(leaves), results)
    fill(plan, results)
    return plan


def recorded(plan: Plan, results: Path) -> dict[str, Any]:
    views = results / "views"
    views.mkdir(exist_ok=True)
    (views / "metrics.csv").write_text("leaf\n")
    tracking.record(plan, results).attach(views)
    return runs(results, plan.settings.experiment)


def runs(results: Path, name: str) -> dict[str, Any]:
    from mlflow.tracking import MlflowClient

    client = MlflowClient(tracking.tracking_uri(results))
    experiment = client.get_experiment_by_name(name)
    assert experiment is not None
    return {run.data.tags["leaf"]: run for run in client.search_runs([experiment.experiment_id])}


def test_the_verdicts_on_claims_are_a_tag_of_the_parent_run(results: Path) -> None:
    plan = finished(1, results)
    assert recorded(plan, results)["plan"].data.tags.get("verdicts", "") == ""
    summary = results / "views" / "summary.json"
    for verdicts, told in (
        ({"reproduced": 2, "not comparable": 1}, "1 not comparable, 2 reproduced"),
        ({"not comparable": 3}, "3 not comparable"),
    ):
        summary.write_text(json.dumps({"verdicts": verdicts}))
        assert recorded(plan, results)["plan"].data.tags["verdicts"] == told


def shown(results: Path, run: Any) -> tuple[Any, ...]:
    """All that the dashboard shows of a run."""
    from mlflow.tracking import MlflowClient

    client = MlflowClient(tracking.tracking_uri(results))
    history = {
        key: sorted((point.step, repr(point.value), point.timestamp) for point in client.get_metric_history(run, key))
        for key in client.get_run(run).data.metrics
    }
    data, info = client.get_run(run).data, client.get_run(run).info
    metrics = {key: repr(value) for key, value in data.metrics.items()}
    place = info.artifact_uri.replace(run, "RUN").partition("/RUN/")[2]
    facts = (info.run_name, info.status, info.lifecycle_stage, info.user_id, place, info.end_time >= info.start_time)
    return data.params, metrics, history, data.tags, facts


@contextmanager
def statements() -> Iterator[list[str]]:
    """The statements that reach a database, without SQLite's settings."""
    seen: list[str] = []

    def note(connection: Any, cursor: Any, statement: str, *_: Any) -> None:
        if not statement.startswith("PRAGMA"):
            seen.append(" ".join(statement.split()))

    sqlalchemy.event.listen(sqlalchemy.Engine, "before_cursor_execute", note)
    try:
        yield seen
    finally:
        sqlalchemy.event.remove(sqlalchemy.Engine, "before_cursor_execute", note)


def test_a_run_is_what_the_client_of_mlflow_writes(results: Path) -> None:
    from mlflow.entities import Metric, Param, RunTag
    from mlflow.tracking import MlflowClient

    client = MlflowClient(tracking.tracking_uri(results))
    identity = client.create_experiment("any", artifact_location=results.as_uri())
    experiment = client.get_experiment(identity)
    series = [("gap", 0, 2.0), ("gap", 3, 1.0), ("gap", 3, 1.0), ("nothing", 0, math.nan), ("nothing", 0, math.nan)]
    series += [("energy", 0, math.inf), ("energy", 0, -1.0), ("history.gap", 10, -0.5), ("history.gap", 5, 7.0)]
    parameters = {"solver.name": "rof", "solver.tolerance": "", "long": "x" * 5000}
    tags = {"leaf": "ours", "failure": "", "note": "two\nlines", "long": "y" * 8000}
    write = sql_store(results)
    run_database.write_runs(
        write, experiment, [(None, run_content.RunContent("r", "FAILED", 0.0, parameters, series, tags))]
    )
    theirs = client.create_run(identity, run_name="r", tags=tags).info.run_id
    metrics = [Metric(name, value, 0, step) for name, step, value in series]
    parts = [RunTag(key, value) for key, value in tags.items()]
    client.log_batch(theirs, metrics, [Param(key, value) for key, value in parameters.items()], parts)
    client.set_terminated(theirs, "FAILED")
    ours = next(run.info.run_id for run in client.search_runs([identity]) if run.info.run_id != theirs)
    assert shown(results, ours) == shown(results, theirs)


def sql_store(results: Path) -> Any:
    from mlflow.store.tracking.sqlalchemy_store import SqlAlchemyStore

    return SqlAlchemyStore(tracking.tracking_uri(results), str(results))


def test_runs_show_options_numbers_history_and_what_came_before(results: Path) -> None:
    plan = finished(2, results)
    found = recorded(plan, results)
    leaf = plan.leaves[1]
    run, parent = found[leaf.key], found["plan"]
    own = store.read_record(results, "solver", leaf.key)["result"]["fields"]["metrics"]["map"]
    events = {
        node.kind: json.loads(event_path(results, node.kind, node.key).read_text())
        for node in plan.stored
        if node.kind != "solver" or node.key == leaf.key
    }
    taken = {f"seconds.{kind}": event["seconds"] for kind, event in events.items()}
    memory = {"peak_memory_mb": max(event["peak_memory_mb"] for event in events.values())}
    history = store.load(results, "solver", leaf.key, "history")
    assert run.data.metrics == {**own, **taken, **memory, "history.gap": history["gap"][-1]}
    given = {key: str(value) for key, value in plan.parameters(leaf).items() if value is not None}
    assert given.items() <= run.data.params.items() and "None" not in run.data.params.values()
    left = {key: value for key, value in run.data.params.items() if key not in given}
    assert left == {"image.width": "default: covers the surface", "solver.step": "default: from the model"}
    expected = {**OWN, "leaf": leaf.key, "configuration": leaf.configuration}
    assert expected.items() <= run.data.tags.items()
    assert run.data.tags["mlflow.parentRunId"] == parent.info.run_id
    assert (run.info.status, parent.info.status) == ("FINISHED", "FINISHED")
    assert [one.info.start_time for one in map(found.get, (x.key for x in plan.leaves)) if one] == sorted(
        found[one.key].info.start_time for one in plan.leaves
    )


def test_statements_do_not_grow_with_the_runs_and_an_unchanged_rerun_asks_once(
    tmp_path: Path, empty_database: Path
) -> None:
    counts = {}
    for leaves in (3, 24):
        results = tmp_path / str(leaves)
        results.mkdir()
        shutil.copy(empty_database, results / "mlflow.db")
        plan = finished(leaves, results)
        with statements() as first:
            recorded(plan, results)
        with statements() as again:
            tracking.record(plan, results).attach(results / "views")
        assert not [text for text in again if not text.startswith("SELECT")]
        assert sum("FROM runs" in text for text in again) == 1, again
        counts[leaves] = len(first), len(again)
    assert counts[3] == counts[24]


def test_a_failed_run_is_taken_over_and_a_changed_one_replaced(results: Path) -> None:
    from mlflow.tracking import MlflowClient

    plan = finished(2, results)
    leaf, other = (one.key for one in plan.leaves)
    store.discard(results, "solver", leaf)
    store.write_text(event_path(results, "solver", leaf), json.dumps({"failure": "solver/primal_dual: no"}))
    before = recorded(plan, results)
    assert (before[leaf].info.status, before["plan"].info.status) == ("FAILED", "FAILED")
    assert before[leaf].data.tags["failure"] == "solver/primal_dual: no"
    client = MlflowClient(tracking.tracking_uri(results))
    client.set_tag(before[leaf].info.run_id, "mlflow.note.content", "of a person")
    fill(plan, results)
    after = recorded(plan, results)
    assert len(after) == 3 and after[leaf].info.run_id == before[leaf].info.run_id
    assert after[leaf].info.status == "FINISHED" and after[leaf].data.tags["failure"] == ""
    assert after[leaf].data.tags["mlflow.note.content"] == "of a person"
    assert after[leaf].info.run_name == before[leaf].info.run_name
    assert after[other].data == before[other].data or vars(after[other].data) == vars(before[other].data)
    event = json.loads(event_path(results, "solver", leaf).read_text())
    store.write_text(event_path(results, "solver", leaf), json.dumps(event | {"seconds": 0.125}))
    again = recorded(plan, results)
    assert again[leaf].data.metrics["seconds.solver"] == 0.125
    assert again[leaf].data.metrics.keys() == after[leaf].data.metrics.keys()
    assert again[leaf].info.end_time - again[leaf].info.start_time == 125
    assert again[leaf].info.start_time == before[leaf].info.start_time


def test_a_row_leads_to_its_run_and_a_new_run_to_its_page(results: Path) -> None:
    plan = finished(2, results)
    database, name = results / "mlflow.db", plan.settings.experiment
    found = recorded(plan, results)
    names = run_names(database, name)
    number = found["plan"].info.experiment_id
    for leaf in plan.leaves:
        run = found[leaf.key]
        assert names[leaf.key] == run.info.run_id
        assert run_place(database, run.info.run_id[:8]) == (number, run.info.run_id)
        page = f"(#/experiments/{number}/runs/{found['plan'].info.run_id}/artifacts/report.html)"
        assert page in run.data.tags["mlflow.note.content"] and leaf.key in run.data.tags["mlflow.note.content"]
    write_report(plan, results)
    text = (results / name / "report.html").read_text()
    assert all(f'<code id="run-{(run := names[leaf.key][:8])}">{run}</code>' in text for leaf in plan.leaves)
    assert "127.0.0.1" not in text  # nothing serves the dashboard to whoever reads the page
    assert run_names(database, "another") == {} and run_place(database, "zzz") is run_place(database, "") is None
    database.write_bytes(b"no database")
    assert run_names(database, name) == run_names(results / "none.db", name) == {}
    assert run_place(database, "1a") is None
    write_report(plan, results)
    assert 'id="run-' not in (results / name / "report.html").read_text()


def test_names_tell_runs_apart_and_durations_are_those_of_the_computation(results: Path) -> None:
    plan = finished(3, results)
    found = recorded(plan, results)
    names = [found[leaf.key].info.run_name for leaf in plan.leaves]
    tolerances = [plan.parameters(leaf)["solver.tolerance"] for leaf in plan.leaves]
    assert names == [f"solver tolerance {tolerance}" for tolerance in tolerances] and len(set(names)) == 3
    for leaf in plan.leaves:
        seconds = json.loads(event_path(results, "solver", leaf.key).read_text())["seconds"]
        info = found[leaf.key].info
        assert info.end_time - info.start_time == round(1000.0 * seconds)


def test_a_run_says_which_table_it_is_in_where_there_are_several(results: Path) -> None:
    tables = [{"comparison": "one", "operator": "fem"}, {"comparison": "other", "operator": "libigl"}]
    plan = plan_of({**sweep(2), "variants": tables}, results)
    assert {name.rpartition(" · ")[2] for name in names_of_runs(plan).values()} == {"one", "other"}
    assert len(set(names_of_runs(plan).values())) == len(plan.leaves) == 4


def test_a_run_of_older_code_is_kept_and_no_longer_current(results: Path) -> None:
    plan = finished(2, results)
    before = recorded(plan, results)
    key, newer = plan.leaves[0].key, "f" * 20
    node = plan.nodes.pop(key)
    plan.nodes[newer] = replace(node, key=newer)
    plan.leaves[0].key = newer
    fill(plan, results)
    after = recorded(plan, results)
    assert len(after) == 4
    assert after[newer].info.run_id != before[key].info.run_id
    assert currents(after) == {"plan": None, key: "false", newer: "true", plan.leaves[1].key: "true"}


@pytest.mark.parametrize("way", ["tables", "client"])
def test_the_current_run_is_that_of_the_code_that_was_run_last(
    results: Path, monkeypatch: pytest.MonkeyPatch, way: str
) -> None:
    if way == "client":
        monkeypatch.setattr(tracking, "_way_to_write", lambda client, *given: (run_client, client))
    plan = finished(2, results)
    edited = copy.deepcopy(plan)
    key, newer = plan.leaves[0].key, "f" * 20
    edited.nodes[newer] = replace(edited.nodes.pop(key), key=newer)
    edited.leaves[0].key = newer
    fill(edited, results)
    beside = {"plan": None, plan.leaves[1].key: "true"}
    for shown, left in ((plan, None), (edited, key), (plan, newer), (plan, newer), (edited, key)):
        after = recorded(shown, results)
        assert currents(after) == beside | {shown.leaves[0].key: "true"} | ({left: "false"} if left else {})


def currents(found: dict[str, Any]) -> dict[str, str | None]:
    return {leaf: run.data.tags.get("current") for leaf, run in found.items()}


INSIDES = ["mlflow.store.tracking.dbmodels.models", "mlflow.store.tracking.sqlalchemy_store", "mlflow.utils.uri"]


@pytest.mark.parametrize("module", INSIDES)
def test_where_mlflow_has_other_tables_its_client_writes_the_same(
    tmp_path: Path, empty_database: Path, monkeypatch: pytest.MonkeyPatch, module: str
) -> None:
    from mlflow.tracking import MlflowClient

    written = []
    for name in ("tables", "client"):
        results = tmp_path / name
        results.mkdir()
        shutil.copy(empty_database, results / "mlflow.db")
        plan = finished(3, results)
        client = MlflowClient(tracking.tracking_uri(results))  # has what it needs before that is hidden from us
        client.search_experiments()
        if name == "client":
            monkeypatch.delitem(sys.modules, "surfexp.records.run_database")
            monkeypatch.setitem(sys.modules, module, None)
            monkeypatch.delattr("surfexp.records.run_database", raising=False)
            assert tracking._way_to_write(client, results, "")[1] is client
        leaf = plan.leaves[0].key
        store.discard(results, "solver", leaf)
        store.write_text(event_path(results, "solver", leaf), json.dumps({"failure": "no"}))
        failed = recorded(plan, results)
        client.set_tag(failed[leaf].info.run_id, "mlflow.note.content", "of a person")
        fill(plan, results)
        first = recorded(plan, results)
        again = recorded(plan, results)
        assert {run.info.run_id for run in again.values()} == {run.info.run_id for run in first.values()}
        assert again[leaf].data.tags["mlflow.note.content"] == "of a person"
        rows = [again[one.key] for one in plan.leaves]
        written.append([(run.info.status, run.info.run_name, run.data.params, numbers(run)) for run in rows])
    assert written[0] == written[1]


def numbers(run: Any) -> dict[str, float]:
    """Metrics but those that a clock or the system measures."""
    return {key: value for key, value in run.data.metrics.items() if "seconds" not in key and "memory" not in key}


def test_a_run_has_its_data_as_datasets_and_its_result_as_a_pointer(results: Path) -> None:
    import mlflow

    plan = finished(3, results)
    found = recorded(plan, results)
    leaf = plan.leaves[1]
    run = found[leaf.key]
    nodes = {node.key: node for node in plan.stored}
    data = {item.dataset.digest: item.dataset for item in run.inputs.dataset_inputs}
    assert {nodes[key].kind for key in data} == {"surface", "image"}
    assert all(json.loads(one.source)["uri"].endswith(key) and Path(json.loads(one.source)["uri"]).is_dir()
               for key, one in data.items())  # fmt: skip
    where = mlflow.artifacts.load_dict(f"{run.info.artifact_uri}/result.json")
    assert (where["result"]["kind"], where["result"]["key"]) == ("solver", leaf.key)
    arrays = results / where["result"]["folder"] / "arrays.npz"
    assert hashlib.sha256(arrays.read_bytes()).hexdigest() == where["result"]["arrays.npz"]
    assert {one["kind"] for one in where["inputs"]} == {"surface", "image", "operator"}
    event = event_path(results, "solver", leaf.key)
    store.write_text(event, json.dumps(json.loads(event.read_text()) | {"seconds": 0.5}))
    again = recorded(plan, results)[leaf.key]
    assert len(again.inputs.dataset_inputs) == 2 and again.info.run_id == run.info.run_id


def test_artifacts_of_a_folder_that_was_moved_are_found_again(tmp_path: Path, empty_database: Path) -> None:
    import mlflow

    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    shutil.copy(empty_database, first / "mlflow.db")
    plan = finished(2, first)
    before = recorded(plan, first)
    first.rename(second)
    after = recorded(plan, second)
    key = plan.leaves[0].key
    assert after[key].info.run_id == before[key].info.run_id
    where = mlflow.artifacts.load_dict(f"{after[key].info.artifact_uri}/result.json")
    assert where["result"]["key"] == key and where["results"] == str(second)
    assert where["export"] == f"surfexp export {key} --results {second}"
    assert str(second) in after[key].info.artifact_uri and not first.exists()
    sources = [json.loads(item.dataset.source)["uri"] for item in after[key].inputs.dataset_inputs]
    assert len(sources) == 2 and all(Path(source).is_relative_to(second) for source in sources)


def test_the_client_alone_writes_the_same_datasets(results: Path) -> None:
    from mlflow.tracking import MlflowClient

    client = MlflowClient(tracking.tracking_uri(results))
    experiment = client.get_experiment(client.create_experiment("any", artifact_location=results.as_uri()))
    data = [run_content.RunDataset("surface cup", "0123", '{"uri": "x"}', "{}")]
    content = run_content.RunContent("r", "FINISHED", 1.0, {}, [], {}, data)
    (theirs,) = run_client.write_runs(client, experiment, [(None, content)])
    (ours,) = run_database.write_runs(sql_store(results), experiment, [(None, content)])
    one, other = (client.get_run(run).inputs.dataset_inputs[0].dataset for run in (theirs, ours))
    assert vars(one) == vars(other)


def test_views_are_tags_of_the_experiment_and_are_written_once(results: Path) -> None:
    plan = finished(1, results)
    (results / "views").mkdir()
    (results / "views" / "metrics.csv").write_text("leaf\n")
    tracking.record(plan, results).attach(results / "views", {"mlflow.sharedViewState.surfexp": "{}"})
    recording = tracking.record(plan, results)
    assert recording.experiment.tags["mlflow.sharedViewState.surfexp"] == "{}"
    with statements() as again:
        recording.attach(results / "views", {"mlflow.sharedViewState.surfexp": "{}"})
    assert not again


def test_every_address_of_the_dashboard_opens_the_pages_of_experiments(
    results: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = recorded(finished(2, results), results)
    names = [run.info.run_id[:8] for leaf, run in found.items() if leaf != "plan"]
    monkeypatch.setattr(ui, "served", lambda *_: 0)
    monkeypatch.setattr(ui, "_check_free", lambda _: None)
    for given in ([], names[:1], names[:2]):
        said = CliRunner().invoke(ui.ui, [*given, "--results", str(results)]).output
        assert "#/experiments/" in said and "workflowType=machine_learning" in said, said
