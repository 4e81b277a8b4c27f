"""A plan carried out: what is missing or damaged is computed by Snakemake, recorded, and shown in a report."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from surfexp.commands import results_lock, slurm_jobs
from surfexp.commands.executors import check_executor, said_at_submission
from surfexp.commands.finishing import finish
from surfexp.commands.processes import drive
from surfexp.commands.progress import follow
from surfexp.commands.terminal import say_once
from surfexp.commands.unfinished_stages import clear, unfinished
from surfexp.lab.errors import StageFailure, UserError, unknown
from surfexp.lab.plan.outcome import read_event
from surfexp.lab.plan.plan import Node, Plan
from surfexp.lab.registry.folders import package_folder
from surfexp.lab.running import compiled_code
from surfexp.lab.store import store

SECONDS_TO_CANCEL = 15.0
NAMED_FILES = 5
PATTERN, ADDRESS = "which Snakemake reads as a pattern", "behind which the address of the runs' database ends"
UNFIT_MARKS = {"{": PATTERN, "}": PATTERN, "?": ADDRESS}


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
    results_lock.hold_results(results, wait=True)
    say_once([store.note_on_older_keys(results)])
    path = plan.write(results)
    tried, stages = set[str](), [(node.kind, node.key) for node in plan.stored]
    store.take_back(results, stages)  # of a run that was killed
    # A stage that finds an input damaged removes it: that result is missing then, and the next round computes it.
    while (missing := unfinished(plan, results)) and not tried.issuperset(missing):
        tried |= missing.keys()
        try:
            clear(plan, results, missing)
            say_once(compiled_code.choose(plan.nodes[key].cache)[1] for key in missing)
            _snakemake(plan, path, results, [plan.nodes[key] for key in missing])
        finally:
            store.take_back(results, stages)
        events = [read_event(results, plan.nodes[key].kind, key) for key in missing]
        say_once(warning for event in events for warning in event.get("warnings", ()))
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
    # a module in the working folder is not imported
    environment = {**os.environ, results_lock.HELD: "1", "PYTHONSAFEPATH": "1"}
    grace = SECONDS_TO_CANCEL if plan.settings.profile else 0.0
    shown, notices = missing or plan.stored, slurm_jobs.Queue() if slurm else list
    code = drive(
        command,
        log,
        lambda it: follow(it, plan.nodes, shown, results, notices),
        grace,
        env=environment,
        pass_fds=results_lock.locks,
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
        results_lock.hold_results(results)
    except UserError as error:
        say_once([str(error)])
        return
    say_once([store.note_on_older_keys(results)])
    missing = unfinished(plan, results).items()
    kinds = {key: plan.nodes[key].kind for key, _ in missing}
    clear(plan, results, {key: said for key, said in missing if said or not store.is_done(results, kinds[key], key)})
