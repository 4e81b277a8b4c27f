"""`surfexp clean`: remove results that no longer belong to a plan."""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

from surfexp.commands.execution import hold_results
from surfexp.workflow.errors import UserError
from surfexp.workflow.plan import read_plan


def command(name: str, arguments: list[str]) -> int:
    """Remove stored results of older code and options, or everything; ask first."""
    parser = argparse.ArgumentParser(f"surfexp {name}", description=__doc__)
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
        path.unlink() if path.is_file() else shutil.rmtree(path)
    return 0


def _everything(results: Path) -> list[Path]:
    return [path for path in results.iterdir() if path.name not in ("README.md", ".lock")]


def _unplanned(results: Path) -> list[Path]:
    latest: dict[str, Path] = {}
    for file in sorted((results / "plans").glob("*.json"), key=lambda file: file.stat().st_mtime):
        latest[file.stem.rpartition("-")[0]] = file
    kept = {key for file in latest.values() for key in read_plan(file).nodes}
    return [folder for folder in (results / "store").glob("*/*") if folder.name not in kept]
