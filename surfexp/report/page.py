"""The report page of an experiment: one table a comparison, its figures below, nothing loaded from elsewhere."""

from __future__ import annotations

import re
import sys
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from surfexp.figures.encode import encode_png
from surfexp.figures.figure import Figure
from surfexp.io.replacing import replacing
from surfexp.lab.errors import DamagedResult
from surfexp.lab.experiment.claim import read_claims
from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import store
from surfexp.records.comparison import Comparison, comparisons
from surfexp.records.failures import failures_of
from surfexp.records.origin import read_origin
from surfexp.records.run_names import run_names
from surfexp.records.table import Row, number_notes, rows_of, to_csv
from surfexp.report.costs import cost_figure
from surfexp.report.declared import declared_by
from surfexp.report.drawing import is_still
from surfexp.report.length_units import name_lengths
from surfexp.report.overview import write_overview, write_summary
from surfexp.report.ranking.section import RankingShown, write_rankings
from surfexp.report.render import render
from surfexp.report.repeats import Repeats, repeats_of
from surfexp.report.search import search_of, write_search
from surfexp.report.stills import addresses, as_data, shown_files
from surfexp.report.turning.turning import Turning
from surfexp.report.verdict import judge

# beyond these a browser becomes slow; the page says what it leaves out and where it stands
ROWS_SHOWN, FIGURES_SHOWN, FAILURES_SHOWN = 500, 200, 20
WRITTEN = re.compile(r"([\w-]+-[0-9a-f]{8}|cost-\d+|ranking-\d+-\d+|search)\.(png|svg)")


@dataclass(frozen=True)
class Section:
    """A comparison as the page shows it: some or all of its rows, its notes by number, its figures.

    `rankings` are of the methods over the problems that they share.
    `figure_of` leads from the place of a row to that of its first figure, `row_of` from a figure to its first row.
    """

    group: Comparison
    rows: list[Row]
    notes: dict[str, int]
    figures: list[dict[str, Any]]
    rankings: list[RankingShown]
    repeats: Repeats | None
    figure_of: dict[int, int]
    row_of: dict[int, int]


def write_report(plan: Plan, results: Path) -> Path:
    """Write `report.html`, `metrics.csv` and `figures/` of a plan below `results/<experiment>/`; return that folder."""
    folder = results / plan.settings.experiment
    rows = rows_of(plan, results)
    groups = comparisons(rows)
    for group in groups:
        group.metrics = declared_by(plan, group.rows)
        name_lengths(group, plan, results)
    figures = _write_figures(plan, results, folder / "figures")
    sections = [_section(group, figures, folder / "figures", k) for k, group in enumerate(groups)]
    turning = Turning(results)
    for item in (item for section in sections for item in section.figures[:FIGURES_SHOWN] if "key" in item):
        item |= turning.of(plan.nodes, item["key"])
    verdicts = judge(read_claims(plan.settings.claims), rows)
    table = to_csv(rows)
    store.write_text(folder / "metrics.csv", table)
    made = read_origin(results, plan)
    search = search_of(rows, plan.settings.objective, made.get("command", ""))
    searched = write_search(search, folder / "figures") if search else ""
    data = as_data(table.encode(), "text/csv;charset=utf-8")
    names = [*_names_of_pictures(sections), *([searched] if searched else [])]
    everything = [item["file"] for section in sections for item in section.figures]
    _remove_others(folder / "figures", {*names, *everything})
    stills, size = addresses(folder / "figures", names, len(data) + sum(map(len, turning.payload.arrays.values())))
    page = render(
        "report.html.j2",
        settings=plan.settings,
        sections=sections,
        figures_shown=FIGURES_SHOWN,
        failures=failures_of(plan, results, rows).most_common(),
        failures_shown=FAILURES_SHOWN,
        verdicts=verdicts,
        stages=len(plan.stored),
        done=sum(store.is_done(results, node.kind, node.key) for node in plan.stored),
        requested=plan.requested,
        made=made,
        search=search,
        searched=searched,
        stills=stills,
        apart=-(-size // 10**6) if shown_files(stills) else 0,
        table=data,
        arrays=turning.payload.arrays,
        scripts=turning.scripts,
        runs=run_names(results / "mlflow.db", plan.settings.experiment),
    )
    store.write_text(folder / "report.html", page)
    write_summary(folder, plan, rows, verdicts, everything[0] if everything else "")
    try:
        write_overview(results)
    except Exception as error:  # whatever lies in other folders: this report is written
        print(f"surfexp: {results / 'index.html'} is not written ({type(error).__name__})", file=sys.stderr)
    return folder


def _names_of_pictures(sections: list[Section]) -> list[str]:
    """The files of all pictures that the page shows, each once."""
    figures = [item["file"] for section in sections for item in section.figures[:FIGURES_SHOWN]]
    return [*dict.fromkeys([*figures, *(ranking.file for section in sections for ranking in section.rankings)])]


def _section(group: Comparison, drawn: Mapping[str, dict[str, Any]], folder: Path, number: int) -> Section:
    shown = group.excerpt(ROWS_SHOWN)
    keys = list(dict.fromkeys(key for row in group.rows for key in row.leaf.figures if key in drawn))
    places = {key: place for place, key in enumerate(keys[:FIGURES_SHOWN])}
    figure_of, row_of = dict[int, int](), dict[int, int]()
    for place, row in enumerate(shown):
        for key in row.leaf.figures:
            if key in places:
                figure_of.setdefault(place, places[key])
                row_of.setdefault(places[key], place)
    pictures = [*(drawn[key] for key in keys), *_costs_of(group, folder, number)]
    rankings = write_rankings(group, folder, number)
    return Section(group, shown, number_notes(shown), pictures, rankings, repeats_of(group), figure_of, row_of)


def _write_figures(plan: Plan, results: Path, folder: Path) -> dict[str, dict[str, Any]]:
    """Encode every finished figure of a plan; names tell what they show."""
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
            name = f"{plan.nodes[key].plugin}-{key[:8]}{_suffix(figure)}"
            if not (folder / name).exists():
                _write(figure, folder / name)
            wanted[key] = {"key": key, **_shown(name, figure)}
    return wanted


def _remove_others(folder: Path, names: Collection[str]) -> None:
    """Remove pictures that reports of other plans wrote; files of a person stay."""
    for file in folder.iterdir():
        if WRITTEN.fullmatch(file.name) and file.name not in names:
            file.unlink()


def _costs_of(group: Comparison, folder: Path, number: int) -> list[dict[str, Any]]:
    figure = cost_figure(group)
    if figure is None:
        return []
    name = f"cost-{number}{_suffix(figure)}"
    _write(figure, folder / name)
    return [_shown(name, figure)]


def _write(figure: Figure, file: Path) -> None:
    with replacing(file) as temporary:
        temporary.write_bytes(figure.svg.encode() if file.suffix == ".svg" else encode_png(figure.pixels))


def _suffix(figure: Figure) -> str:
    """.svg where a figure has a drawing; what a stranger's results call one may be anything, then its pixels are shown."""
    return ".svg" if figure.svg and is_still(figure.svg) else ".png"


def _shown(name: str, figure: Figure) -> dict[str, Any]:
    """What the page needs of a figure; its pixels are let go."""
    height, width = figure.pixels.shape[:2]
    return {"file": name, "title": figure.title, "caption": figure.caption, "width": width, "height": height}
