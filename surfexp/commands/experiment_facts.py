"""`surfexp info EXPERIMENT`: its question, data and methods, what it cost here and what came out."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from rich.table import Table

from surfexp.commands.console import Console
from surfexp.lab.experiment.experiment_files import methods_named, read_experiment
from surfexp.lab.registry.catalogue import Catalogue
from surfexp.report.words import duration

# what an experiment draws says little of what it asks
NOT_SHOWN = ("figure",)


def print_facts(name: str, known: Catalogue, results: Path, console: Console) -> None:
    """Print what the file of an experiment says, and what is known of its last run in a results folder."""
    document = read_experiment(name)
    console.print(f"{name}: {document.get('title', '')}\n")
    if document.get("description"):
        console.print(f"{document['description'].strip()}\n")
    table = Table.grid(padding=(0, 2))
    for kind, methods in methods_named(document, known.kinds).items():
        if kind not in NOT_SHOWN:
            table.add_row(kind, ", ".join(methods))
    claims = document.get("claims") or []
    if claims:
        table.add_row("claims", f"{len(claims)}, judged after each run")
    for row in _last_run(name, results):
        table.add_row(*row)
    table.add_row("run it", f"surfexp run experiment={name}")
    table.add_row("its stages", f"surfexp plan experiment={name}")
    console.print(table)


def _last_run(name: str, results: Path) -> list[tuple[str, str]]:
    """What the summary beside the report says; one row where there is none."""
    with suppress(OSError, ValueError, TypeError, KeyError, AttributeError):
        found: dict[str, Any] = json.loads((results / name / "summary.json").read_text(encoding="utf-8"))
        troubled = [f"{int(found[key])} {word}" for key, word in (("failed", "failed"), ("limited", "not converged"))]
        rows = f"{int(found['rows'])} rows" + "".join(f", {text}" for text in troubled if not text.startswith("0 "))
        verdicts = ", ".join(f"{int(count)} {word}" for word, count in dict(found["verdicts"]).items())
        told = [
            ("last report", f"{found['date']}: {rows}, {duration(float(found['seconds']))} in its last stages"),
            ("verdicts", verdicts),
            ("page", str(results / name / "report.html")),
        ]
        return [row for row in told if row[1]]
    return [("last report", f"none in {results}")]
