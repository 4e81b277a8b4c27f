"""What follows when the stages of a plan are done: their records in MLflow, and the pages made from them."""

from __future__ import annotations

import os
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from surfexp.commands.terminal import say_once
from surfexp.lab.digests import digest
from surfexp.lab.errors import UserError
from surfexp.lab.plan.outcome import event_path
from surfexp.lab.plan.plan import Node, Plan
from surfexp.lab.registry.catalogue import code_state
from surfexp.lab.store import store


def finish(path: Path, plan: Plan, arguments: Sequence[str] | None = None, computed: bool = True) -> None:
    """Record a plan's events in MLflow and write its views: report, table, figures; nothing if that is done already."""
    results = path.parent.parent
    if is_finished(path, plan):
        return
    state, done = _state(path, plan, results), _done(results, plan)
    from surfexp.records.origin import forget_origin, note_origin
    from surfexp.records.tracking import record
    from surfexp.report.page import write_report  # which draws with matplotlib

    done.unlink(missing_ok=True)
    with _told("the report is not written"):
        if arguments is not None:
            note_origin(results, plan, arguments, computed)
        elif computed:
            forget_origin(results, plan)
        recording = None
        with _told("runs are not recorded in MLflow"):  # before the page, which leads to them
            recording = record(plan, results)
            say_once(recording.said)
        folder = write_report(plan, results)
        with _told("the report is not kept in MLflow"):
            if recording:
                recording.attach(folder, _dashboard(plan, results))
                store.write_text(done, state)


def _dashboard(plan: Plan, results: Path) -> dict[str, str]:
    """Tags that let the dashboard open an experiment by its tables, and not as one of language models."""
    from surfexp.records.comparison import comparisons
    from surfexp.records.table import rows_of
    from surfexp.report.dashboard_view import TAG, dashboard_view
    from surfexp.report.declared import declared_by

    groups = comparisons(rows_of(plan, results))
    for group in groups:
        group.metrics = declared_by(plan, group.rows)
    return {TAG: dashboard_view(groups, plan.settings.objective), "mlflow.experimentKind": "custom_model_development"}


def is_finished(path: Path, plan: Plan) -> bool:
    """Whether the records and pages of a plan are those of its results as they are now."""
    results = path.parent.parent
    views, done = results / plan.settings.experiment, _done(results, plan)
    files = (done, views / "report.html", results / "index.html", results / "mlflow.db")
    return all(file.exists() for file in files) and done.read_text() == _state(path, plan, results)


def _done(results: Path, plan: Plan) -> Path:
    return results / "cache" / "finished" / f"{plan.settings.experiment}.txt"


@contextmanager
def _told(what: str) -> Iterator[None]:
    """Say in one line what could not be done: results, their table and the exit code do not depend on it."""
    try:
        yield
    except UserError:
        raise
    except Exception as error:  # of MLflow, SQLAlchemy, SQLite, matplotlib, templates: any of them
        if os.environ.get("SURFEXP_DEBUG"):
            traceback.print_exc()
        reason = " ".join(str(error).split())[:200]
        say_once([f"{what} ({type(error).__name__}: {reason}); results are kept, the same command tries again"])


def _state(path: Path, plan: Plan, results: Path) -> str:
    """Digest of all that reports and records are made from: the plan, what its stages left, and our own code."""
    files = [file for node in plan.stored for file in _left_by(results, node) if file.exists()]
    facts = [(str(file), stat.st_size, stat.st_mtime_ns) for file in files for stat in [file.stat()]]
    return digest([path.read_text(), facts, code_state(Path.cwd())])


def _left_by(results: Path, node: Node) -> list[Path]:
    record = store.result_folder(results, node.kind, node.key) / store.RECORD
    return [record, event_path(results, node.kind, node.key)]
