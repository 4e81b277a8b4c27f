"""`surfexp clean`: remove results that no longer belong to a plan."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import click

from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError

# what runs make below a results folder, which may hold other files as well
MADE = ("store/*/*", "plans/*.json", "events/*/*", "mlflow.db*", "mlflow-artifacts", "logs/*.snakemake.log", "logs/*/*.log",
        "logs/*/*.benchmark.tsv", "cache/numba", "cache/finished", "cache/verified.json")  # fmt: skip


@click.command(**shown("clean", "", "--all --yes", cls=click.Command))
@click.option("--all", "everything", is_flag=True, help="remove every result, plan, log and the dashboard's runs")
@click.option("--yes", is_flag=True, help="do not ask")
@results_option
def clean(everything: bool, yes: bool, results: Path) -> None:
    """Remove stored results that no plan names.

    These are results of older code and options. It is asked first.
    """
    from surfexp.commands.execution import hold_results

    if not (results / "store").exists():
        raise UserError(f"{results} holds no stored results")
    hold_results(results)
    found = _everything(results) if everything else _unplanned(results)
    doomed = [path for path in found if _is_below(path, results)]
    if left := [path for path in found if path not in doomed]:
        echo(f"left alone: {len(left)} entries that lie elsewhere, behind links, as {left[0]}", err=True)
    if not doomed:
        echo("nothing to remove: every stored result belongs to the latest plan of its experiment")
        return
    size = sum(file.lstat().st_size for path in doomed for file in ([path] if path.is_file() else path.rglob("*")))
    echo(f"{len(doomed)} entries, {size / 1e6:.1f} MB, below {results}")
    if not yes and (not sys.stdin.isatty() or not click.confirm("remove them?")):
        echo("nothing removed; --yes removes without asking")
        return
    for path in doomed:
        path.unlink() if path.is_file() else shutil.rmtree(path)
    while empty := _without_content(results):
        for folder in empty:
            folder.rmdir()


def _is_below(path: Path, results: Path) -> bool:
    """Whether no link stands between the results folder and an entry, the entry itself included."""
    return path.resolve() == results.resolve() / path.relative_to(results)


def _everything(results: Path) -> list[Path]:
    from surfexp.report.overview import is_ours

    experiments = {file.stem.rpartition("-")[0] for file in (results / "plans").glob("*.json")}
    pages = [results / name for name in experiments if (results / name / "report.html").is_file()]
    overview = [page for page in [results / "index.html"] if is_ours(page)]
    return [path for pattern in MADE for path in results.glob(pattern)] + pages + overview


def _without_content(results: Path) -> list[Path]:
    """Folders of ours that nothing is left in, the inner ones first."""
    ours = [path for name in ("store", "events", "logs", "plans", "cache") for path in (results / name).glob("**")]
    return [
        path
        for path in sorted(ours, reverse=True)
        if path.is_dir() and _is_below(path, results) and not any(path.iterdir())
    ]


def _unplanned(results: Path) -> list[Path]:
    from surfexp.lab.plan.plan import read_plan

    latest: dict[str, Path] = {}
    for file in sorted((results / "plans").glob("*.json"), key=lambda file: file.stat().st_mtime):
        latest[file.stem.rpartition("-")[0]] = file
    kept = {key for file in latest.values() for key in read_plan(file).nodes}
    return [folder for folder in (results / "store").glob("*/*") if folder.name not in kept]
