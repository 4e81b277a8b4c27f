"""`surfexp export`: finished tables as CSV, and named sulci as label files for the usual tools, as often as is asked."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.commands.views import latest_plan
from surfexp.workflow.errors import UserError
from surfexp.workflow.plan import Node, Plan
from surfexp.workflow.store import is_done, load

SULCI = ("statistic", "sulcal_table")


def command(name: str, arguments: list[str]) -> int:
    """Write the tables of an experiment's statistics, and the named sulci of each surface where sulci were measured."""
    parser = argparse.ArgumentParser(f"surfexp {name}", description=__doc__)
    parser.add_argument("experiment")
    parser.add_argument("--to", type=Path, default=Path("export"), help="folder, made when it is not there")
    parser.add_argument("--results", type=Path, default=Path("results"), help="results folder")
    given = parser.parse_args(arguments)
    plan = latest_plan(given.results, given.experiment)
    tables = [plan.nodes[leaf.key] for leaf in plan.leaves if plan.nodes[leaf.key].kind == "statistic"]
    if not tables:
        kinds = ", ".join(sorted({plan.nodes[leaf.key].kind for leaf in plan.leaves}))
        raise UserError(f"experiment {given.experiment!r} ends in {kinds}, only statistics are exported")
    for number, node in enumerate(tables, 1):
        for file in _export(plan, node, given.results, given.to, f"-{number}" if len(tables) > 1 else ""):
            print(file)
    return 0


def _export(plan: Plan, node: Node, results: Path, folder: Path, suffix: str) -> list[Path]:
    from surfexp.studies.sulci.length_table import KEYS
    from surfexp.studies.sulci.sulcal_export import write_length_table

    statistic = _result(results, node, plan)
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / f"{re.sub(r'[^a-z0-9.]+', '_', statistic.name.lower())}{suffix}.csv"]
    columns: dict[str, Any] = {}
    for name in sorted(statistic.columns, key=lambda name: name not in KEYS):
        values = statistic.columns[name]
        parts = np.asarray(values).reshape(len(values), -1).T
        columns |= {name + end: part for end, part in zip(("", ", low", ", high"), parts, strict=False)}
    count = max(map(len, columns.values()), default=0)
    write_length_table(files[0], statistic.rows or tuple(str(k) for k in range(1, count + 1)), columns)
    if (node.kind, node.plugin) == SULCI:
        files += _sulci(plan, node, results, folder)
    return files


def _sulci(plan: Plan, node: Node, results: Path, folder: Path) -> list[Path]:
    from surfexp.studies.sulci.sulcal_export import export_sulci
    from surfexp.studies.sulci.sulcal_measurement import name_sulci
    from surfexp.studies.sulci.sulcal_template import make_template

    template, surfaces = node.inputs["template"], node.inputs["surfaces"]
    assert isinstance(template, str) and isinstance(surfaces, dict)
    study = make_template(_result(results, plan.nodes[template], plan), int(node.options["regions"]))
    files: list[Path] = []
    for label, key in surfaces.items():
        surface = _result(results, plan.nodes[key], plan)
        named = name_sulci(study, surface)
        files += export_sulci(folder, label, surface, named, int(study.regions.max()) + 1)
    return files


def _result(results: Path, node: Node, plan: Plan) -> Any:
    if not is_done(results, node.kind, node.key):
        name = plan.settings.experiment
        raise UserError(f"{node.kind}/{node.plugin} of {name!r} is not finished: surfexp run experiment={name}")
    return load(results, node.kind, node.key)
