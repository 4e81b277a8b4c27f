"""MLflow: one idempotent function turns the outcomes of a plan's stages into runs. Only the driver calls it."""

from __future__ import annotations

import logging
import os
import subprocess
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

from surfexp.workflow import store
from surfexp.workflow.fingerprint import digest
from surfexp.workflow.outcome import NOT_COMPUTED, Outcome, outcome
from surfexp.workflow.plan import Leaf, Plan

PACKAGES = ("surfexp", "numpy", "scipy", "numba", "libigl", "snakemake", "hydra-core", "mlflow")


def tracking_uri(results: Path) -> str:
    """Address of the MLflow database of a results folder."""
    return f"sqlite:///{results.resolve() / 'mlflow.db'}"


def record(plan: Plan, results: Path, views: Path) -> None:
    """Create or update one run a leaf, below one parent run for the experiment; a second call changes nothing.

    A run belongs to (experiment, leaf key). A leaf whose earlier run failed takes that run over; a run of the same
    configuration under older code keeps a tag `current=false`.
    """
    os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")
    os.environ.setdefault("MLFLOW_LOGGING_LEVEL", "WARNING")
    logging.getLogger("alembic").setLevel(logging.WARNING)
    from mlflow.tracking import MlflowClient

    client = MlflowClient(tracking_uri(results))
    name = plan.settings.experiment
    experiment = client.get_experiment_by_name(name)
    location = (results / "mlflow-artifacts").resolve().as_uri()
    identity = experiment.experiment_id if experiment else client.create_experiment(name, artifact_location=location)
    runs = client.search_runs([identity], max_results=50000)
    by_leaf = {run.data.tags.get("leaf"): run for run in runs}
    parent = by_leaf.get("plan") or client.create_run(identity, run_name=name, tags={"leaf": "plan"})
    outcomes = {node.key: outcome(results, node) for node in plan.stored}
    failed = False
    for leaf in plan.leaves:
        upstream = {key: outcomes[key] for key in _upstream(plan, leaf.key) if key in outcomes}
        state = digest([[asdict(item) for item in upstream.values()], leaf.parameters])
        failed |= bool(outcomes[leaf.key].failure)
        same = [run for run in runs if run.data.tags.get("configuration") == leaf.configuration]
        run = by_leaf.get(leaf.key) or next((run for run in same if run.info.status == "FAILED"), None)
        if run is not None and run.data.tags.get("state") == state:
            continue
        tags = {"leaf": leaf.key, "configuration": leaf.configuration, "current": "true"}
        tags["mlflow.parentRunId"] = parent.info.run_id
        run = run or client.create_run(identity, run_name=_label(leaf), tags=tags)
        kinds = {key: plan.nodes[key].kind for key in upstream}
        history = {} if outcomes[leaf.key].failure else store.load(results, kinds[leaf.key], leaf.key, "history") or {}
        _fill(client, run.info.run_id, leaf, upstream, kinds, history, {**tags, **_versions(), "state": state})
        for old in same:
            if old.info.run_id != run.info.run_id:
                client.set_tag(old.info.run_id, "current", "false")
    state = digest([sorted(leaf.key for leaf in plan.leaves), failed, (views / "metrics.csv").read_text()])
    if parent.data.tags.get("state") != state:
        for tag, value in {"plan": plan.identity, "state": state, **_versions()}.items():
            client.set_tag(parent.info.run_id, tag, value)
        client.log_artifacts(parent.info.run_id, str(views))
        client.set_terminated(parent.info.run_id, "FAILED" if failed else "FINISHED")


def _fill(
    client: Any,
    run_id: str,
    leaf: Leaf,
    upstream: Mapping[str, Outcome],
    kinds: Mapping[str, str],
    history: Mapping[str, Any],
    tags: dict[str, str],
) -> None:
    from mlflow.entities import Metric, Param, RunTag

    known = client.get_run(run_id).data.params
    parameters = [Param(key, str(value)[:6000]) for key, value in leaf.parameters.items() if key not in known]
    metrics = dict(upstream[leaf.key].metrics)
    for key, item in upstream.items():
        name = f"seconds.{kinds[key]}"
        metrics[name] = metrics.get(name, 0.0) + (item.seconds or 0.0)
        metrics["peak_memory_mb"] = max(metrics.get("peak_memory_mb", 0.0), item.peak_memory_mb or 0.0)
    series = [Metric(_safe(key), value, 0, 0) for key, value in metrics.items()]
    steps = history.get("iteration", [])
    series += [
        Metric(f"history.{_safe(key)}", float(value), 0, int(step))
        for key, values in history.items()
        if key != "iteration"
        for step, value in zip(steps, values, strict=False)
    ]
    failures = [item.failure for item in upstream.values() if item.failure not in ("", NOT_COMPUTED)]
    for part in range(max(len(series) // 900, len(parameters) // 100) + 1):  # MLflow's limits of one batch
        client.log_batch(run_id, series[900 * part : 900 * (part + 1)], parameters[100 * part : 100 * (part + 1)], [])
    client.log_batch(
        run_id, [], [], [RunTag(key, value) for key, value in {**tags, "failure": "; ".join(failures)}.items()]
    )
    client.set_terminated(run_id, "FAILED" if upstream[leaf.key].failure else "FINISHED")


def _upstream(plan: Plan, key: str) -> list[str]:
    found: dict[str, None] = {}
    for child in plan.nodes[key].children:
        found.update(dict.fromkeys(_upstream(plan, child)))
    return [*found, key]


def _label(leaf: Leaf) -> str:
    return " ".join(str(value) for key, value in leaf.parameters.items() if key.endswith(".name"))[:250]


def _safe(name: str) -> str:
    return "".join(c if c.isalnum() or c in "_-./ " else "_" for c in name)


def _versions() -> dict[str, str]:
    commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=False)
    versions = {f"version.{name}": version(name) for name in PACKAGES}
    return {**versions, "git_commit": commit.stdout.strip() or "not a checkout"}
