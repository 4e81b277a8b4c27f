"""A plan carried out: what is missing or damaged is computed by Snakemake, recorded, and shown in a report."""

from __future__ import annotations

import fcntl
import os
import shutil
import sys
import traceback
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from surfexp.commands import slurm_jobs
from surfexp.commands.executors import check_executor, said_at_submission
from surfexp.commands.processes import drive
from surfexp.commands.progress import follow
from surfexp.commands.terminal import echo
from surfexp.lab.digests import digest
from surfexp.lab.errors import StageFailure, UserError, unknown
from surfexp.lab.plan.outcome import event_path, read_event
from surfexp.lab.plan.plan import Node, Plan
from surfexp.lab.registry.catalogue import code_state
from surfexp.lab.registry.folders import package_folder
from surfexp.lab.running import compiled_code
from surfexp.lab.store import store

HELD = "SURFEXP_HOLDS_RESULTS"
SECONDS_TO_CANCEL = 15.0
LINES_OF_DAMAGE, NAMED_FILES = 10, 5
PATTERN, ADDRESS = "which Snakemake reads as a pattern", "behind which the address of the runs' database ends"
UNFIT_MARKS = {"{": PATTERN, "}": PATTERN, "?": ADDRESS}
_locks: list[int] = []


def run(plan: Plan, arguments: Sequence[str] | None = None) -> None:
    """Run what is missing of a plan, record it and write the report, with the arguments that asked for it.

    StageFailure if a stage failed.
    """
    profile = _profile(plan.settings.profile or "default")
    if plan.settings.profile:
        check_executor(plan.settings.profile, slurm_jobs.settings_of(profile))
    results = Path(plan.settings.results).resolve()
    for mark in str(results):
        if why := UNFIT_MARKS.get(mark, "" if mark.isprintable() else "which is not printed"):
            raise UserError(f"results folder {str(results)!r} has a {mark!r}, {why}: choose another name")
    hold_results(results, wait=True)
    _warn([store.note_on_older_keys(results)])
    path = plan.write(results)
    tried, stages = set[str](), [(node.kind, node.key) for node in plan.stored]
    store.take_back(results, stages)  # of a run that was killed
    # A stage that finds an input damaged removes it: that result is missing then, and the next round computes it.
    while (missing := unfinished(plan, results)) and not tried.issuperset(missing):
        tried |= missing.keys()
        try:
            clear(plan, results, missing)
            _warn(compiled_code.choose(plan.nodes[key].cache)[1] for key in missing)
            _snakemake(plan, path, results, [plan.nodes[key] for key in missing])
        finally:
            store.take_back(results, stages)
        events = [read_event(results, plan.nodes[key].kind, key) for key in missing]
        _warn(warning for event in events for warning in event.get("warnings", ()))
    finish(path, plan, arguments, bool(tried))
    if missing:
        failures: dict[str, dict[str, None]] = {}
        for key in missing:
            if failure := read_event(results, plan.nodes[key].kind, key).get("failure"):
                failures.setdefault(failure, {}).update(dict.fromkeys(_surface_of(plan, key)))
        said = "\n".join(failure + _in_brackets(list(files)) for failure, files in failures.items())
        raise StageFailure(said or f"{len(missing)} stages did not run; see {results / 'logs'}")


def _surface_of(plan: Plan, key: str) -> list[str]:
    """The file of the one surface that a stage depends on; nothing where there are none or several."""
    found, waiting = dict[str, None](), [key]
    while waiting:
        node = plan.nodes[waiting.pop()]
        path = node.options.get("path") if node.kind == "surface" else None
        found.update({Path(str(path)).name: None} if path else {})
        waiting += node.children
    return list(found) if len(found) == 1 else []


def _in_brackets(files: list[str]) -> str:
    more = f" and {len(files) - NAMED_FILES} more" if len(files) > NAMED_FILES else ""
    return f" ({', '.join(files[:NAMED_FILES])}{more})" if files else ""


def _warn(lines: Iterable[str]) -> None:
    for line in dict.fromkeys(filter(None, lines)):
        echo(f"surfexp: {line}", err=True)


def unfinished(plan: Plan, results: Path) -> dict[str, str]:
    """Stages of a plan without a sound result, by key: "" where there is none, else what is wrong with it.

    In benchmark mode, a leaf that was not measured alone is among them.
    """
    leaves = [plan.nodes[leaf.key] for leaf in plan.leaves] if plan.settings.timing else []
    events = {node.key: read_event(results, node.kind, node.key) for node in leaves}
    untimed = {key: "" for key, event in events.items() if event.get("failure") or not event.get("alone")}
    return untimed | store.faults(results, [(node.kind, node.key) for node in plan.stored])


def clear(plan: Plan, results: Path, missing: Mapping[str, str]) -> None:
    """Remove what is left of unfinished stages: damaged results, which are named, and the traces of earlier runs.

    Sound results that are to be measured again are set aside.
    """
    lines = []
    for key, fault in missing.items():
        kind = plan.nodes[key].kind
        lines += [fault] if fault else [read_event(results, kind, key).get("damage", "")]
        is_sound = not fault and store.is_done(results, kind, key)
        (store.set_aside if is_sound else store.discard)(results, kind, key)
        for suffix in (".json", ".progress"):
            event_path(results, kind, key).with_suffix(suffix).unlink(missing_ok=True)
    lines = [line for line in lines if line]
    for line in lines[:LINES_OF_DAMAGE]:
        echo(f"surfexp: {line}; it is removed and computed again", err=True)
    if len(lines) > LINES_OF_DAMAGE:
        print(f"surfexp: and {len(lines) - LINES_OF_DAMAGE} results more", file=sys.stderr)


def _snakemake(plan: Plan, path: Path, results: Path, missing: list[Node]) -> None:
    rules = Path(compiled_code.__file__).with_name("rules.smk")
    profile = _profile(plan.settings.profile or "default")
    settings = slurm_jobs.settings_of(profile) if plan.settings.profile else {}
    slurm = settings.get("executor") == "slurm"
    cores = 1 if plan.settings.timing else plan.settings.cores or settings.get("cores") or os.cpu_count() or 1
    command = [sys.executable, "-P", "-m", "surfexp.lab.running.snakemake", str(os.getpid())]
    command += ["--snakefile", str(rules), "--workflow-profile", str(profile), "--nolock"]
    command += [] if plan.settings.profile else ["--executor", "surfexp"]
    command += ["--cores", str(cores), "--config", f"plan={path}", "only_missing=1"]
    command += slurm_jobs.requests(plan.nodes, missing, results, settings) if slurm else []
    log = results / "logs" / f"{path.stem}.snakemake.log"
    environment = {**os.environ, HELD: "1", "PYTHONSAFEPATH": "1"}  # a module in the working folder is not imported
    grace = SECONDS_TO_CANCEL if plan.settings.profile else 0.0
    shown, notices = missing or plan.stored, slurm_jobs.Queue() if slurm else list
    code = drive(
        command,
        log,
        lambda it: follow(it, plan.nodes, shown, results, notices),
        grace,
        env=environment,
        pass_fds=_locks,
    )
    if slurm:
        slurm_jobs.tell_of_ended(log.read_text(), missing, results)
    if code and not any(read_event(results, node.kind, node.key).get("failure") for node in missing):
        said = log.read_text()
        last = said_at_submission(said) or next(
            (line for line in said.splitlines()[::-1] if line.strip()), "no message"
        )
        reason = f"Snakemake stopped: {last}; see {log}"
        if code < 0:
            reason = f"Snakemake was killed by signal {-code}; the same command continues"
        if shutil.disk_usage(results).free < 2**20:
            reason = f"the disk of {results} is full; free some space, then the same command continues"
        raise StageFailure(reason)


def _profile(name: str) -> Path:
    """Folder of a Snakemake profile: one of one's own, or one that comes with the package, from wherever it is run."""
    shipped = package_folder("surfexp.profiles")
    for folder in (Path(name), shipped / name.removeprefix("profiles/")):
        if any(folder.glob("config*.yaml")):
            return folder.resolve()
    raise unknown("profile", name, [f"profiles/{path.parent.name}" for path in shipped.glob("*/config*.yaml")])


def before_snakemake(plan: Plan, results: Path) -> None:
    """What plain Snakemake does before it looks for results, in a dry run too: nothing sound is removed.

    Nothing at all is removed while another run works in the folder.
    """
    try:
        hold_results(results)
    except UserError as error:
        _warn([str(error)])
        return
    _warn([store.note_on_older_keys(results)])
    missing = unfinished(plan, results).items()
    kinds = {key: plan.nodes[key].kind for key, _ in missing}
    clear(plan, results, {key: said for key, said in missing if said or not store.is_done(results, kinds[key], key)})


def hold_results(results: Path, wait: bool = False) -> None:
    """Take the results folder for this process; a second run waits for it, or is refused when `wait` is false."""
    if os.environ.get(HELD) or _locks:
        return
    results.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(results / ".lock", os.O_RDWR | os.O_CREAT)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        if not wait:
            os.close(descriptor)
            raise UserError(f"results folder {results} is in use by another run; wait for it to end") from None
        echo(f"{results} is in use by another run; waiting for it to end", err=True)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
    except OSError as error:  # of a file system without locks
        _warn([f"{results} cannot be locked ({error.strerror}): let one run at a time work there"])
    _locks.append(descriptor)


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
            _warn(recording.said)
        folder = write_report(plan, results)
        with _told("the report is not kept in MLflow"):
            if recording:
                recording.attach(folder, _dashboard(plan, results))
                store.write_text(done, state)


def _dashboard(plan: Plan, results: Path) -> dict[str, str]:
    """Tags that let the dashboard open an experiment by its tables, and not as one of language models."""
    from surfexp.records.table import comparisons, rows_of
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
        _warn([f"{what} ({type(error).__name__}: {reason}); results are kept, the same command tries again"])


def _state(path: Path, plan: Plan, results: Path) -> str:
    """Digest of all that reports and records are made from: the plan, what its stages left, and our own code."""
    files = [file for node in plan.stored for file in _left_by(results, node) if file.exists()]
    facts = [(str(file), stat.st_size, stat.st_mtime_ns) for file in files for stat in [file.stat()]]
    return digest([path.read_text(), facts, code_state(Path.cwd())])


def _left_by(results: Path, node: Node) -> list[Path]:
    record = store.result_folder(results, node.kind, node.key) / store.RECORD
    return [record, event_path(results, node.kind, node.key)]
