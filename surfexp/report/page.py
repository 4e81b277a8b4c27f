"""The report page of an experiment: one table a comparison, its figures below, nothing loaded from elsewhere."""

from __future__ import annotations

import re
import sys
from collections import Counter
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader
from markupsafe import Markup, escape

from surfexp.figures.encode import encode_png
from surfexp.figures.figure import Figure
from surfexp.report.claim import read_claims
from surfexp.report.costs import cost_figure
from surfexp.report.table import Comparison, comparisons, format_number, number_notes, rows_of, short_name, to_csv
from surfexp.report.verdict import judge
from surfexp.workflow import store
from surfexp.workflow.errors import DamagedResult
from surfexp.workflow.plan import Plan

# beyond these a browser becomes slow; the page says what it leaves out and where it stands
ROWS_SHOWN, FIGURES_SHOWN, FAILURES_SHOWN = 500, 200, 20


def write_report(plan: Plan, results: Path) -> Path:
    """Write `report.html`, `metrics.csv` and `figures/` of a plan below `results/<experiment>/`; return that folder."""
    folder = results / plan.settings.experiment
    rows = rows_of(plan, results)
    groups = comparisons(rows)
    figures = _write_figures(plan, results, folder / "figures")
    costs = [_costs_of(group, folder / "figures", k) for k, group in enumerate(groups)]
    store.write_text(folder / "metrics.csv", to_csv(rows))
    environment = Environment(loader=PackageLoader("surfexp.report", "templates"), autoescape=True)
    environment.filters.update(number=format_number, heading=short_name, prose=prose)
    sections = [
        (group, shown, number_notes(shown), [*_figures_of(group, figures), *cost])
        for group, cost in zip(groups, costs, strict=True)
        for shown in [group.excerpt(ROWS_SHOWN)]
    ]
    page = environment.get_template("report.html.j2").render(
        settings=plan.settings,
        sections=sections,
        figures_shown=FIGURES_SHOWN,
        failures=Counter(row.failure for row in rows if row.failure).most_common(),
        failures_shown=FAILURES_SHOWN,
        verdicts=judge(read_claims(plan.settings.claims), rows),
        stages=len(plan.stored),
        requested=plan.requested,
    )
    store.write_text(folder / "report.html", page)
    return folder


def prose(text: str) -> Markup:
    """A text as the page shows it: everything as written, what stands between backticks as code."""
    return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(text))))


def _write_figures(plan: Plan, results: Path, folder: Path) -> dict[str, dict[str, Any]]:
    """Encode every finished figure of a plan; names tell what they show, files of other plans are removed."""
    wanted: dict[str, dict[str, Any]] = {}
    folder.mkdir(parents=True, exist_ok=True)
    for leaf in plan.leaves:
        for key in leaf.figures:
            if key in wanted or not store.is_done(results, "figure", key):
                continue
            try:
                figure = store.load(results, "figure", key)
            except DamagedResult as error:
                print(f"surfexp: {error}; the next run computes it again", file=sys.stderr)
                continue
            name = f"{plan.nodes[key].plugin}-{key[:8]}.png"
            if not (folder / name).exists():
                _write(figure, folder / name)
            wanted[key] = _shown(name, figure)
    names = {item["file"] for item in wanted.values()}
    for file in folder.glob("*.png"):
        if file.name not in names:
            file.unlink()
    return wanted


def _costs_of(group: Comparison, folder: Path, number: int) -> list[dict[str, Any]]:
    figure, name = cost_figure(group), f"cost-{number}.png"
    if figure is None:
        return []
    _write(figure, folder / name)
    return [_shown(name, figure)]


def _write(figure: Figure, file: Path) -> None:
    temporary = file.with_name(f".{file.name}")
    temporary.write_bytes(encode_png(figure.pixels))
    temporary.rename(file)


def _shown(name: str, figure: Figure) -> dict[str, Any]:
    """What the page needs of a figure; its pixels are let go."""
    height, width = figure.pixels.shape[:2]
    return {"file": name, "title": figure.title, "caption": figure.caption, "width": width, "height": height}


def _figures_of(group: Comparison, figures: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    keys = dict.fromkeys(key for row in group.rows for key in row.leaf.figures)
    return [figures[key] for key in keys if key in figures]
