"""`surfexp clean`: remove results that no longer belong to a plan."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from surfexp.commands.execution import hold_results
from surfexp.commands.parser import Parser
from surfexp.lab.errors import UserError
from surfexp.lab.plan.plan import read_plan
from surfexp.report.overview import is_ours

# what runs make below a results folder, which may hold other files as well
MADE = ("store/*/*", "plans/*.json", "events/*/*", "mlflow.db*", "mlflow-artifacts", "logs/*.snakemake.log", "logs/*/*.log",
        "logs/*/*.benchmark.tsv", "cache/numba", "cache/finished", "cache/verified.json")  # fmt: skip


def command(name: str, arguments: list[str]) -> int:
    """Remove stored results of older code and options, or everything; ask first."""
    parser = Parser(f"surfexp {name}", description=__doc__)
    parser.add_argument("--results", type=Path, default=Path("results"), help="results folder")
    parser.add_argument("--all", action="store_true", help="remove every result, plan, log and the dashboard's runs")
    parser.add_argument("--yes", action="store_true", help="do not ask")
    given = parser.parse_args(arguments)
    if not (given.results / "store").exists():
        raise UserError(f"{given.results} holds no stored results")
    hold_results(given.results)
    doomed = _everything(given.results) if given.all else _unplanned(given.results)
    if not doomed:
        print("nothing to remove: every stored result belongs to the latest plan of its experiment")
        return 0
    size = sum(file.stat().st_size for path in doomed for file in ([path] if path.is_file() else path.rglob("*")))
    print(f"{len(doomed)} entries, {size / 1e6:.1f} MB, below {given.results}")
    if not given.yes and (not sys.stdin.isatty() or input("remove them? [y/N] ").strip().lower() != "y"):
        print("nothing removed; --yes removes without asking")
        return 0
    for path in doomed:
        path.unlink() if path.is_file() or path.is_symlink() else shutil.rmtree(path)
    while empty := _without_content(given.results):
        for folder in empty:
            folder.rmdir()
    return 0


def _everything(results: Path) -> list[Path]:
    experiments = {file.stem.rpartition("-")[0] for file in (results / "plans").glob("*.json")}
    pages = [results / name for name in experiments if (results / name / "report.html").is_file()]
    overview = [page for page in [results / "index.html"] if is_ours(page)]
    return [path for pattern in MADE for path in results.glob(pattern)] + pages + overview


def _without_content(results: Path) -> list[Path]:
    """Folders of ours that nothing is left in, the inner ones first."""
    ours = [path for name in ("store", "events", "logs", "plans", "cache") for path in (results / name).glob("**")]
    return [path for path in sorted(ours, reverse=True) if path.is_dir() and not any(path.iterdir())]


def _unplanned(results: Path) -> list[Path]:
    latest: dict[str, Path] = {}
    for file in sorted((results / "plans").glob("*.json"), key=lambda file: file.stat().st_mtime):
        latest[file.stem.rpartition("-")[0]] = file
    kept = {key for file in latest.values() for key in read_plan(file).nodes}
    return [folder for folder in (results / "store").glob("*/*") if folder.name not in kept]
