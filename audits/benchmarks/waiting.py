"""What a user waits for outside of the methods: planning, a run with nothing to do, the report, the records in MLflow."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from audits.benchmarks.line import Line
from audits.benchmarks.measurement import Cost, apart, cost_of_children, measure, median_cost, peak_memory
from audits.benchmarks.synthetic_results import fill, fill_experiment, plan_of, sweep
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan.plan import read_plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.records.tracking import record
from surfexp.report.page import write_report

LIMIT = "a limit"
SIZES, QUICK_SIZES = (2_000, 10_000, 100_000), (50, 100, 200)
NOTE = "results made by hand"


def warm_up() -> None:
    """Load the plugins of the sweep."""
    with TemporaryDirectory() as folder:
        plan_of(sweep(10), Path(folder))


def lines(quick: bool) -> list[Line]:
    """Return the lines of planning, reports and records, and those of whole commands."""
    small, large, largest = QUICK_SIZES if quick else SIZES
    found = [_planning(large, 1.3), _planning(largest, 20.0, memory=1.0)]
    with TemporaryDirectory() as folder:
        found += [_report(small, 1.0, Path(folder) / "small"), _report(large, 6.0, Path(folder) / "large")]
        found += _records(large, Path(folder) / "large")
        found += _nothing_to_do(Path(folder) / "finished")
    return found


def _limit(work: str, seconds: float, cost: Cost, accuracy: str = "", met: bool = True) -> Line:
    met = met and cost.cpu <= seconds
    return Line(work, LIMIT, f"≤ {seconds:g} s", f"{cost.cpu:.3g} s", met, cost, accuracy=accuracy, note=NOTE)


def _planning(leaves: int, seconds: float, memory: float = float("inf")) -> Line:
    cost, reading, gigabytes = apart(_plan_apart, leaves)
    told = f"peak memory of the process {gigabytes:.2f} GB"
    told += f", at most {memory:g}" if memory < float("inf") else ""
    told += f"; a stage reads its part of the plan in {1e3 * reading:.3g} ms"
    return _limit(f"plan of {leaves:,} leaves", seconds, cost, told, gigabytes <= memory)


def _plan_apart(leaves: int) -> tuple[Cost, float, float]:
    """Plan in a process of its own, whose memory is its own; plugins are loaded before."""
    warm_up()
    open_catalogue(Path.cwd())
    plan, cost = measure(lambda: make_plan(expand(sweep(leaves))), 1)
    memory = peak_memory() / 1e9
    with TemporaryDirectory() as folder:
        path = plan.write(Path(folder))
        begin = time.process_time()
        read_plan(path, plan.leaves[-1].key)
        return cost, time.process_time() - begin, memory


def _report(rows: int, seconds: float, results: Path) -> Line:
    plan = plan_of(sweep(rows), results)
    fill(plan, results)
    folder, cost = measure(partial(write_report, plan, results), 1)
    size = (folder / "report.html").stat().st_size / 1e6
    return _limit(f"report of {rows:,} rows", seconds, cost, f"page of {size:.2f} MB")


def _records(runs: int, results: Path) -> list[Line]:
    plan = plan_of(sweep(runs), results)
    _, first = measure(partial(record, plan, results), 1)
    _, again = measure(partial(record, plan, results), 1)
    return [
        _limit(f"MLflow: {runs:,} runs recorded", 60.0, first, "the database is made anew"),
        _limit(f"MLflow: {runs:,} runs recorded, nothing new", 3.0, again),
    ]


def _nothing_to_do(results: Path) -> list[Line]:
    """Whole commands in processes of their own, the second time."""
    plan = fill_experiment("quickstart", results)
    work = f"quickstart, {len(plan.stored)} stages, all of them done"
    arguments = ["experiment=quickstart", f"results={results}"]
    surfexp = [sys.executable, "-m", "surfexp.commands.command_line"]
    commands: list[tuple[str, list[str], float]] = [
        (f"surfexp run, {work}", [*surfexp, "run", *arguments], 1.5),
        (f"surfexp plan, {work}", [*surfexp, "plan", *arguments], 1.2),
    ]
    if shutil.which("snakemake") or Path(sys.executable).with_name("snakemake").exists():
        snakemake = [sys.executable, "-m", "snakemake", "-n", "-c1", "--config", *arguments]
        commands.append((f"snakemake -n, {work}", snakemake, 3.0))
    found = []
    for text, command, seconds in commands:
        subprocess.run(command, capture_output=True, check=True)
        found.append(_limit(text, seconds, _cost_of_command(command)))
    return found


def _cost_of_command(command: list[str]) -> Cost:
    run = partial(subprocess.run, command, capture_output=True, check=True)
    costs = [cost_of_children(run) for _ in range(3)]
    return median_cost([(cost.cpu, cost.wall) for cost in costs])
