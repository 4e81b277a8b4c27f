"""Many MLflow runs at once: read with one query, written in a few transactions through the tracking store's own models.

MLflow's client takes several transactions for each run, and each of them asks whether the run is there; so this follows its
`SqlAlchemyStore.create_run` and `log_batch`, table by table.
"""

from __future__ import annotations

import json
import time
import uuid
from collections.abc import Iterable, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

from mlflow.entities import LifecycleStage, SourceType
from mlflow.store.tracking.dbmodels.models import (
    SqlDataset,
    SqlExperiment,
    SqlInput,
    SqlLatestMetric,
    SqlMetric,
    SqlParam,
    SqlRun,
    SqlTag,
)
from mlflow.utils.file_utils import local_file_uri_to_path
from mlflow.utils.mlflow_tags import MLFLOW_RUN_NAME
from mlflow.utils.uri import append_to_uri_path
from sqlalchemy import bindparam, delete, func, insert, select, update

from surfexp.records.run_content import LONGEST_PARAMETER, LONGEST_TAG, KnownRun, RunContent

RUNS_AT_ONCE = 500
_TABLE = SqlRun.__table__
_CHANGED = (
    update(_TABLE)
    .where(_TABLE.c.run_uuid == bindparam("run"))
    .values(name=bindparam("called"), status=bindparam("state"), end_time=_TABLE.c.start_time + bindparam("took"))
)


def known_runs(store: Any, experiment: str, tags: Iterable[str]) -> list[KnownRun]:
    """The active runs of an experiment, the latest first."""
    query = (
        select(SqlRun.run_uuid, SqlRun.status, SqlTag.key, SqlTag.value)
        .join(SqlTag, (SqlTag.run_uuid == SqlRun.run_uuid) & SqlTag.key.in_(list(tags)))
        .where(SqlRun.experiment_id == int(experiment), SqlRun.lifecycle_stage == LifecycleStage.ACTIVE)
        .order_by(SqlRun.start_time.desc(), SqlRun.run_uuid)
    )
    runs: dict[str, KnownRun] = {}
    with store.ManagedSessionMaker() as session:
        for identity, status, key, value in session.execute(query):
            runs.setdefault(identity, KnownRun(identity, status)).tags[key] = value
    return list(runs.values())


def write_runs(store: Any, experiment: Any, contents: Iterable[tuple[str | None, RunContent]]) -> list[str]:
    """Write runs, each with the identity of the run that it takes the place of (None for a new one), some at a time.

    Of a run that is replaced, parameters, metrics and the tags that are given are written anew; other tags stay.
    Returns the identities of the runs.
    """
    waiting, written = iter(contents), list[str]()
    while part := list(islice(waiting, RUNS_AT_ONCE)):
        new = [(uuid.uuid4().hex, content) for identity, content in part if identity is None]
        old = [(identity, content) for identity, content in part if identity is not None]
        now = int(time.time() * 1000)
        with store.ManagedSessionMaker(read_only=False) as session:
            if new:  # a millisecond apart, so that the dashboard shows them in their order
                starts = range(now - len(new), now)
                rows = [_run(experiment, *item, start) for item, start in zip(new, starts, strict=True)]
                session.execute(insert(SqlRun), rows)
            if old:
                _forget(session, old)
                session.connection().execute(_CHANGED, [{"run": run, "took": _milliseconds(item), "called": item.name,
                                                         "state": item.status} for run, item in old])  # fmt: skip
            for table, rows in _rows(store, [*new, *old]).items():
                if rows:
                    session.execute(insert(table), rows)
            _write_datasets(session, int(experiment.experiment_id), [*new, *old])
        fresh = iter(identity for identity, _ in new)
        written += [identity or next(fresh) for identity, _ in part]
    return written


def relocate(store: Any, experiment: Any, location: str) -> None:
    """Tell the runs of an experiment that their artifacts and data lie elsewhere: the results folder was moved."""
    before, number = experiment.artifact_location, int(experiment.experiment_id)
    folders = [json.dumps(f"{Path(local_file_uri_to_path(uri)).parent}/")[1:-1] for uri in (before, location)]
    changes: dict[Any, dict[str, Any]] = {
        SqlExperiment: {"artifact_location": location},
        SqlRun: {"artifact_uri": func.replace(SqlRun.artifact_uri, before, location)},
        SqlDataset: {"dataset_source": func.replace(SqlDataset.dataset_source, *folders)},
    }
    with store.ManagedSessionMaker(read_only=False) as session:
        for table, value in changes.items():
            session.execute(update(table).where(table.experiment_id == number).values(value))


def set_tag(store: Any, identities: Sequence[str], key: str, value: str) -> None:
    """Give a tag of several runs, which have it already, another value."""
    with store.ManagedSessionMaker(read_only=False) as session:
        for start in range(0, len(identities), RUNS_AT_ONCE):
            part = identities[start : start + RUNS_AT_ONCE]
            session.execute(update(SqlTag).where(SqlTag.key == key, SqlTag.run_uuid.in_(part)).values(value=value))


def _milliseconds(content: RunContent) -> int:
    return round(1000.0 * content.seconds)


def _run(experiment: Any, identity: str, content: RunContent, start: int) -> dict[str, Any]:
    return {
        "run_uuid": identity,
        "name": content.name,
        "artifact_uri": append_to_uri_path(experiment.artifact_location, identity, "artifacts"),
        "experiment_id": int(experiment.experiment_id),
        "source_type": SourceType.to_string(SourceType.UNKNOWN),
        "source_name": "",
        "entry_point_name": "",
        "source_version": "",
        "user_id": "unknown",
        "status": content.status,
        "start_time": start,
        "end_time": start + _milliseconds(content),
        "lifecycle_stage": LifecycleStage.ACTIVE,
    }


def _forget(session: Any, runs: Sequence[tuple[str, RunContent]]) -> None:
    identities = [run for run, _ in runs]
    for table in (SqlParam, SqlMetric, SqlLatestMetric):
        session.execute(delete(table).where(table.run_uuid.in_(identities)))
    session.execute(delete(SqlInput).where(SqlInput.destination_type == "RUN", SqlInput.destination_id.in_(identities)))
    keys = {MLFLOW_RUN_NAME, *(key for _, content in runs for key in content.tags)}
    session.execute(delete(SqlTag).where(SqlTag.run_uuid.in_(identities), SqlTag.key.in_(keys)))


def _write_datasets(session: Any, experiment: int, runs: Sequence[tuple[str, RunContent]]) -> None:
    """Data of runs, each once in an experiment, and what run takes which, as `SqlAlchemyStore.log_inputs` writes them."""
    wanted = {(one.name, one.digest): one for _, content in runs for one in content.datasets}
    if not wanted:
        return
    query = select(SqlDataset.name, SqlDataset.digest, SqlDataset.dataset_uuid)
    query = query.where(SqlDataset.experiment_id == experiment)
    known = {(name, digest): identity for name, digest, identity in session.execute(query)}
    new = {key: uuid.uuid4().hex for key in wanted if key not in known}
    rows = [
        {
            "dataset_uuid": new[key],
            "experiment_id": experiment,
            "name": one.name,
            "digest": one.digest,
            "dataset_source_type": "local",
            "dataset_source": one.source,
            "dataset_profile": one.profile,
        }
        for key, one in wanted.items()
        if key in new
    ]
    if rows:
        session.execute(insert(SqlDataset), rows)
    taken = {
        (known | new)[one.name, one.digest] + run: {
            "input_uuid": uuid.uuid4().hex,
            "source_type": "DATASET",
            "source_id": (known | new)[one.name, one.digest],
            "destination_type": "RUN",
            "destination_id": run,
        }
        for run, content in runs
        for one in content.datasets
    }
    session.execute(insert(SqlInput), list(taken.values()))


def _rows(store: Any, runs: Sequence[tuple[str, RunContent]]) -> dict[Any, list[dict[str, Any]]]:
    """Rows of every table but that of the runs; as MLflow writes them, without repeated metrics."""
    rows: dict[Any, list[dict[str, Any]]] = {SqlParam: [], SqlMetric: [], SqlLatestMetric: [], SqlTag: []}
    for run, content in runs:
        rows[SqlParam] += [
            {"run_uuid": run, "key": key, "value": value[:LONGEST_PARAMETER]}
            for key, value in content.parameters.items()
        ]
        rows[SqlTag] += [
            {"run_uuid": run, "key": key, "value": value[:LONGEST_TAG]}
            for key, value in {**content.tags, MLFLOW_RUN_NAME: content.name}.items()
        ]
        points = dict.fromkeys(
            (name, step, *store.sanitize_metric_value(value)) for name, step, value in content.series
        )
        metrics = [
            {"run_uuid": run, "key": name, "value": value, "timestamp": 0, "step": step, "is_nan": is_nan}
            for name, step, is_nan, value in points
        ]
        rows[SqlMetric] += metrics
        last = {row["key"]: row for row in sorted(metrics, key=lambda row: (row["step"], row["value"]))}
        rows[SqlLatestMetric] += last.values()
    return rows
