"""MLflow: one idempotent function turns the outcomes of a plan's stages into runs. Only the driver calls it."""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from surfexp.lab.digests import digest
from surfexp.lab.errors import UserError
from surfexp.lab.plan.outcome import NOT_COMPUTED, Outcome, outcome
from surfexp.lab.plan.plan import Leaf, Plan
from surfexp.lab.registry.registry import plugin
from surfexp.lab.store import store
from surfexp.records.origin import commit
from surfexp.records.table import DATA, Row, comparisons, short_name

if TYPE_CHECKING:
    from surfexp.records.run_content import KnownRun, RunContent, RunDataset

DATABASE = "mlflow.db"
NOTE = "mlflow.note.content"
# what a run shows: another number writes the runs of earlier versions again
CONTENT = 2
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
        self.client.log_artifacts(self.parent, str(views))
        self.client.set_terminated(self.parent, "FAILED" if self.failed else "FINISHED")

    def _keep_artifacts(self, views: Path) -> None:
        from mlflow.utils.file_utils import local_file_uri_to_path

        from surfexp.records.run_artifacts import keep_artifacts

        results, places = views.parent, dict[str, Any]()
        for leaf in self.plan.leaves:
            folder = Path(local_file_uri_to_path(self.experiment.artifact_location)) / self.runs[leaf.key] / "artifacts"
            keep_artifacts(folder, self.plan, leaf, results, views / "figures", places)


def record(plan: Plan, results: Path) -> Recording:
    """Create or update one run a leaf, below one parent run for the experiment; a second call changes nothing.

    A run belongs to (experiment, leaf key). A leaf whose earlier run failed takes that run over; a run of the same
    configuration under older code keeps a tag `current=false`.
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
    runs = written.known_runs(database, experiment.experiment_id, ("leaf", "configuration", "state"))
    parent = next((run for run in runs if run.tags.get("leaf") == "plan"), None)
    parent_id = parent.identity if parent else _new_parent(client, experiment.experiment_id, name)
    outcomes = {node.key: outcome(results, node) for node in plan.stored}
    versions = _versions()
    changes = _changes(plan, outcomes, runs)
    tags = {**versions, "mlflow.parentRunId": parent_id}
    page = f"#/experiments/{experiment.experiment_id}/runs/{parent_id}/artifacts/report.html"
    names = _names(plan) if changes else {}
    identities = written.write_runs(
        database,
        experiment,
        ((change.run, _content(plan, results, change, outcomes, names, tags, page)) for change in changes),
    )
    written.set_tag(database, [run for change in changes for run in change.superseded], "current", "false")
    by_leaf = {run.tags["leaf"]: run.identity for run in reversed(runs) if "leaf" in run.tags}
    by_leaf |= {change.leaf.key: run for change, run in zip(changes, identities, strict=True)}
    failed = any(outcomes[leaf.key].failure for leaf in plan.leaves)
    state = (sorted(leaf.key for leaf in plan.leaves), failed)
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


@dataclass(frozen=True)
class _Change:
    """A leaf that is not recorded as it is: the stored stages before it, the run that it takes, those of older code."""

    leaf: Leaf
    upstream: tuple[str, ...]
    state: str
    run: str | None
    superseded: list[str]


def _changes(plan: Plan, outcomes: Mapping[str, Outcome], runs: Sequence[KnownRun]) -> list[_Change]:
    by_leaf = {run.tags.get("leaf"): run for run in runs}
    by_configuration: dict[str | None, list[KnownRun]] = {}
    for run in runs:
        by_configuration.setdefault(run.tags.get("configuration"), []).append(run)
    states = {key: digest(asdict(item)) for key, item in outcomes.items()}
    upstream: dict[str, tuple[str, ...]] = {}
    changes, taken = [], set[str]()
    for leaf in plan.leaves:
        stored = tuple(key for key in _upstream(plan, leaf.key, upstream) if key in outcomes)
        state = digest([[states[key] for key in stored], leaf.configuration, CONTENT])
        same = by_configuration.get(leaf.configuration, [])
        free = (run for run in same if run.status == "FAILED" and run.identity not in taken)
        mine = by_leaf.get(leaf.key) or next(free, None)
        if mine is None or mine.tags.get("state") != state:
            identity = mine.identity if mine else None
            others = [one.identity for one in same if one.identity != identity]
            changes.append(_Change(leaf, stored, state, identity, others))
            taken |= {identity} if identity else set()
    return changes


def _content(
    plan: Plan,
    results: Path,
    change: _Change,
    outcomes: Mapping[str, Outcome],
    names: Mapping[str, str],
    tags: Mapping[str, str],
    page: str,
) -> RunContent:
    """What the run of a leaf shows: its options, its numbers and history, what the stages before it took.

    A new run leads to the page with its row; after that its note is a person's.
    """
    from surfexp.records.run_content import RunContent

    leaf, own = change.leaf, outcomes[change.leaf.key]
    upstream = {key: outcomes[key] for key in change.upstream}
    metrics = dict(own.metrics)
    for key, item in upstream.items():
        name = f"seconds.{plan.nodes[key].kind}"
        metrics[name] = metrics.get(name, 0.0) + (item.seconds or 0.0)
        metrics["peak_memory_mb"] = max(metrics.get("peak_memory_mb", 0.0), item.peak_memory_mb or 0.0)
    kind = plan.nodes[leaf.key].kind
    history = {} if own.failure else store.load(results, kind, leaf.key, "history") or {}
    series = [(_safe(key), 0, value) for key, value in metrics.items()]
    steps = history.get("iteration", [])
    series += [
        (f"history.{_safe(key)}", int(step), float(value))
        for key, values in history.items()
        if key != "iteration"
        for step, value in zip(steps, values, strict=False)
    ]
    failures = [item.failure for item in upstream.values() if item.failure not in ("", NOT_COMPUTED)]
    own_tags = {"leaf": leaf.key, "configuration": leaf.configuration, "current": "true", "state": change.state}
    parameters = {key: str(value) for key, value in _used(plan, leaf).items()}
    status = "FAILED" if own.failure else "FINISHED"
    note = (
        {} if change.run else {NOTE: f"A row of [report.html]({page}): `{leaf.key}` in the column leaf of metrics.csv."}
    )
    all_tags = {**tags, **own_tags, **note, "failure": "; ".join(failures)}
    return RunContent(
        names[leaf.key], status, own.seconds or 0.0, parameters, series, all_tags, _datasets(plan, change, results)
    )


def _used(plan: Plan, leaf: Leaf) -> dict[str, Any]:
    """The options of a leaf; of one that was left to its method, what its description says of the default, or nothing."""
    used, given = {}, plan.parameters(leaf)
    for name, value in given.items():
        if value is None:
            stage, _, option = name.rpartition(".")
            kind = stage.rpartition(".")[2]
            value = _default(kind, str(given.get(f"{stage}.name")), option)
        if value is not None:
            used[name] = value
    return used


@cache
def _default(kind: str, method: str, option: str) -> str | None:
    """What the description of an option says behind "default:"; None where it says nothing, or the method is unknown."""
    with suppress(UserError, ImportError, KeyError):
        described = plugin(kind, method).options.model_fields[option].description or ""
        return (described.partition("default: ")[2] and f"default: {described.partition('default: ')[2]}") or None
    return None


def _datasets(plan: Plan, change: _Change, results: Path) -> list[RunDataset]:
    """The surfaces and images that a leaf was made from."""
    from surfexp.records.run_content import RunDataset

    found = []
    for node in (plan.nodes[key] for key in change.upstream if plan.nodes[key].kind in DATA):
        said = ", ".join(f"{name} {value}" for name, value in node.options.items() if value not in (None, "", []))
        place = store.result_folder(results, node.kind, node.key)
        files = ", ".join(f"{name} sha256 {value}" for name, value in node.files.items())
        profile = json.dumps({"method": node.plugin, "options": said[:500], "files": files[:500]})
        source = json.dumps({"uri": str(place)})
        found.append(RunDataset(f"{node.kind} {node.plugin}", node.key[:36], source, profile))
    return found


def _upstream(plan: Plan, key: str, known: dict[str, tuple[str, ...]]) -> tuple[str, ...]:
    """All stages before one, and itself; `known` are those that were asked for before."""
    if key not in known:
        before = dict.fromkeys(one for child in plan.nodes[key].children for one in _upstream(plan, child, known))
        known[key] = (*before, key)
    return known[key]


def _names(plan: Plan) -> dict[str, str]:
    """A name for the run of every leaf: what tells it from the others of its table, then the table among several."""
    groups = comparisons([Row(leaf, plan.parameters(leaf), {}, None) for leaf in plan.leaves])
    names = {}
    for group in groups:
        for row in group.rows:
            known = [(name, row.parameters[name]) for name in group.varying if row.parameters.get(name) is not None]
            parts = [str(value) if name.endswith(".name") else f"{short_name(name)} {value}" for name, value in known]
            where = [group.title] if len(groups) > 1 else []
            names[row.leaf.key] = " · ".join([*(parts or [row.leaf.key[:8]]), *where])[:250]
    return names


def _safe(name: str) -> str:
    return "".join(c if c.isalnum() or c in "_-./ " else "_" for c in name)


def _versions() -> dict[str, str]:
    """Versions of the packages, and the commit that the dashboard shows as the version of the source."""
    found = {f"version.{name}": version(name) for name in PACKAGES}
    return {**found, "git_commit": commit(), "mlflow.source.git.commit": commit(), "mlflow.source.name": "surfexp"}
