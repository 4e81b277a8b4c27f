"""`surfexp clean`: remove results that belong to no plan."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from surfexp.commands.click_command import results_option, shown
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError

if TYPE_CHECKING:
    from surfexp.lab.plan.plan import Plan

# what runs make below a results folder, which may hold other files as well
MADE = ("store/*/*", "store/KEYS", "plans/*.json", "plans/order.txt", "events/*/*", "mlflow.db*", "mlflow-artifacts",
        "logs/*.snakemake.log", "logs/*/*.log", "logs/*/*.benchmark.tsv",
        "cache/numba", "cache/finished", "cache/verified.json")  # fmt: skip


@click.command(**shown("clean", "", "--older", "--all --yes", cls=click.Command))
@click.option("--older", is_flag=True, help="remove plans of older code first, whose rows were planned again since")
@click.option("--all", "everything", is_flag=True, help="remove every result, plan, log and the dashboard's runs")
@click.option("--yes", is_flag=True, help="do not ask")
@results_option
def clean(older: bool, everything: bool, yes: bool, results: Path) -> None:
    """Remove stored results that no plan names.

    It is asked first. Every run leaves its plan as FOLDER/plans/EXPERIMENT-KEY.json: remove one by hand to give up what it
    alone names.
    """
    from surfexp.commands.results_lock import hold_results

    if not (results / "store").exists():
        raise UserError(f"{results} holds no stored results")
    hold_results(results)
    found = _everything(results) if everything else _unplanned(results, older)
    doomed = [path for path in found if _is_below(path, results)]
    if left := [path for path in found if path not in doomed]:
        echo(f"left alone: {len(left)} entries that lie elsewhere, behind links, as {left[0]}", err=True)
    if not doomed:
        echo("nothing to remove: plans name every stored result" + ("" if older else "; --older removes older plans"))
        return
    size = sum(file.lstat().st_size for path in doomed for file in ([path] if path.is_file() else path.rglob("*")))
    given_up = sorted({_experiment(path) for path in doomed if path.parent == results / "plans"})
    of = f", with plans of {', '.join(given_up)}" if given_up else ", which no plan names"
    echo(f"{len(doomed)} entries, {size / 1e6:.1f} MB, below {results}{of}")
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

    experiments = {_experiment(file) for file in (results / "plans").glob("*.json")}
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


def _unplanned(results: Path, older: bool) -> list[Path]:
    """Stored results that no plan names, and older plans if they are not to count."""
    from surfexp.lab.plan.plan import plans_by_age

    plans = {file: _read(file) for file in plans_by_age(results)}
    latest = {(_experiment(file), _asked(plan)): file for file, plan in plans.items()}
    dropped = set(plans) - set(latest.values()) if older else set[Path]()
    kept = {key for file, plan in plans.items() if file not in dropped for key in plan.nodes}
    return [*dropped, *(folder for folder in (results / "store").glob("*/*") if folder.name not in kept)]


def _experiment(plan: Path) -> str:
    return plan.stem.rpartition("-")[0]


def _asked(plan: Plan) -> frozenset[str]:
    """What a plan is asked for, whatever the code: the options of its rows and figures."""
    from surfexp.lab.digests import digest
    from surfexp.lab.plan.plan import flat_parameters

    ends = [key for leaf in plan.leaves for key in (leaf.key, *leaf.figures)]
    return frozenset(digest(flat_parameters(plan.nodes, key)) for key in ends)


def _read(file: Path) -> Plan:
    from surfexp.lab.plan.plan import read_plan

    try:
        return read_plan(file)
    except (ValueError, KeyError, TypeError, IndexError, OSError) as error:
        reason = f"{type(error).__name__}: {' '.join(str(error).split())[:80]}"
        raise UserError(f"plan {file} cannot be read ({reason}): remove it to give up what it alone names") from None
