"""MLflow: one idempotent function turns the outcomes of a plan's stages into runs. Only the driver calls it."""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from surfexp.lab.digests import digest
from surfexp.lab.plan.outcome import outcome
from surfexp.lab.plan.plan import Plan
from surfexp.records.leaf_changes import changes_of, wrongly_tagged
from surfexp.records.leaf_run import names_of_runs, run_of_leaf
from surfexp.records.origin import commit

DATABASE = "mlflow.db"
PACKAGES = ("surfexp", "numpy", "scipy", "numba", "libigl", "snakemake", "hydra-core", "mlflow")


def tracking_uri(results: Path) -> str:
    """Address of the MLflow database of a results folder."""
    return f"sqlite:///{results.resolve() / DATABASE}"


@dataclass(frozen=True)
class Recording:
    """What a plan's runs are recorded below; `said` is what was wrong with the database, a line each.

    `runs` are the identities of the runs by the keys of their leaves.
    """

    client: Any
    experiment: Any
    plan: Plan
    runs: Mapping[str, str]
    parent: str
    parent_tags: Mapping[str, str]
    own_tags: Mapping[str, str]
    state: tuple[Any, ...]
    failed: bool
    said: tuple[str, ...]

    def attach(self, views: Path, view: Mapping[str, str] | None = None) -> None:
        """Keep pages as artifacts of the parent run, figures and places of results as those of the others.

        The parent run is ended. Nothing happens if it has these pages. `view` are tags of the experiment that say how it
        is shown.
        """
        for tag, value in (view or {}).items():
            if self.experiment.tags.get(tag) != value:
                self.client.set_experiment_tag(self.experiment.experiment_id, tag, value)
        verdicts = _verdicts(views / "summary.json")
        state = digest([*self.state, verdicts, (views / "metrics.csv").read_text()])
        if self.parent_tags.get("state") == state:
            return
        for tag, value in {**self.own_tags, "verdicts": verdicts, "state": state}.items():
            self.client.set_tag(self.parent, tag, value)
        self._keep_artifacts(views)
        self.client.set_terminated(self.parent, "FAILED" if self.failed else "FINISHED")

    def _keep_artifacts(self, views: Path) -> None:
        from mlflow.store.artifact.local_artifact_repo import LocalArtifactRepository
        from mlflow.utils.file_utils import local_file_uri_to_path

        from surfexp.records.run_artifacts import keep_artifacts

        # the client remembers where artifacts of a run were before the folder was moved
        LocalArtifactRepository(f"{self.experiment.artifact_location}/{self.parent}/artifacts").log_artifacts(
            str(views)
        )
        results, places = views.parent, dict[str, Any]()
        for leaf in self.plan.leaves:
            folder = Path(local_file_uri_to_path(self.experiment.artifact_location)) / self.runs[leaf.key] / "artifacts"
            keep_artifacts(folder, self.plan, leaf, results, views / "figures", places)


def record(plan: Plan, results: Path) -> Recording:
    """Create or update one run a leaf, below one parent run for the experiment; a second call changes nothing.

    A run belongs to (experiment, leaf key). A leaf whose earlier run failed takes that run over; a run of the same
    configuration under other code has the tag `current=false`, until that code is run again.
    """
    os.environ.setdefault("MLFLOW_DISABLE_TELEMETRY", "true")
    os.environ.setdefault("MLFLOW_LOGGING_LEVEL", "WARNING")
    os.environ.setdefault("MLFLOW_SQLALCHEMYSTORE_POOLCLASS", "NullPool")  # a kept connection is to a file set aside
    logging.getLogger("alembic").setLevel(logging.WARNING)
    from mlflow.tracking import MlflowClient

    from surfexp.records.database_file import prepare

    said: tuple[str, ...] = (prepare(results / DATABASE),)
    client = MlflowClient(tracking_uri(results))
    name = plan.settings.experiment
    location = (results / "mlflow-artifacts").resolve().as_uri()
    experiment = client.get_experiment_by_name(name) or client.get_experiment(
        client.create_experiment(name, artifact_location=location)
    )
    if experiment.lifecycle_stage == "deleted":
        client.restore_experiment(experiment.experiment_id)
        said += (f"experiment {name!r} was deleted in MLflow: it is restored",)
    written, database = _way_to_write(client, results, location)
    if experiment.artifact_location != location:
        written.relocate(database, experiment, location)
        experiment = client.get_experiment(experiment.experiment_id)
    runs = written.known_runs(database, experiment.experiment_id, ("leaf", "configuration", "state", "current"))
    parent = next((run for run in runs if run.tags.get("leaf") == "plan"), None)
    parent_id = parent.identity if parent else _new_parent(client, experiment.experiment_id, name)
    outcomes = {node.key: outcome(results, node) for node in plan.stored}
    versions = _versions()
    changes = changes_of(plan, outcomes, runs)
    tags = {**versions, "mlflow.parentRunId": parent_id}
    page = f"#/experiments/{experiment.experiment_id}/runs/{parent_id}/artifacts/report.html"
    names = names_of_runs(plan) if changes else {}
    identities = written.write_runs(
        database,
        experiment,
        ((change.run, run_of_leaf(plan, results, change, outcomes, names, tags, page)) for change in changes),
    )
    by_leaf = {run.tags["leaf"]: run.identity for run in reversed(runs) if "leaf" in run.tags}
    by_leaf |= {change.leaf.key: run for change, run in zip(changes, identities, strict=True)}
    rewritten = {change.run for change in changes}
    others = [run for run in runs if run.identity not in rewritten]
    for value, wrong in wrongly_tagged(plan, by_leaf, others).items():
        written.set_tag(database, wrong, "current", value)
    failed = any(outcomes[leaf.key].failure for leaf in plan.leaves)
    state = (sorted(leaf.key for leaf in plan.leaves), failed, str(results.resolve()))
    own_tags = {"plan": plan.identity, **versions}
    known, told = parent.tags if parent else {}, tuple(line for line in said if line)
    return Recording(client, experiment, plan, by_leaf, parent_id, known, own_tags, state, failed, told)


def _verdicts(summary: Path) -> str:
    """How often each verdict was given on an experiment's claims, for a column of the dashboard."""
    found = json.loads(summary.read_text(encoding="utf-8"))["verdicts"] if summary.exists() else {}
    return ", ".join(f"{count} {word}" for word, count in sorted(found.items()))


def _way_to_write(client: Any, results: Path, location: str) -> tuple[Any, Any]:
    """The module that writes runs, and what it writes to: MLflow's tables, or its client where they are others."""
    try:
        from mlflow.store.tracking.sqlalchemy_store import SqlAlchemyStore

        from surfexp.records import run_database

        return run_database, SqlAlchemyStore(tracking_uri(results), location)
    except (ImportError, AttributeError):
        from surfexp.records import run_client

        return run_client, client


def _new_parent(client: Any, experiment: str, name: str) -> str:
    return str(client.create_run(experiment, run_name=name, tags={"leaf": "plan"}).info.run_id)


def _versions() -> dict[str, str]:
    """Versions of the packages, and the commit that the dashboard shows as the version of the source."""
    found = {f"version.{name}": version(name) for name in PACKAGES}
    return {**found, "git_commit": commit(), "mlflow.source.git.commit": commit(), "mlflow.source.name": "surfexp"}
